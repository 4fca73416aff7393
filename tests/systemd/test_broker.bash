#!/usr/bin/env bash
# The broker dies, and the broker hangs: everything is back with no hand on it.
# shellcheck source=common.bash
source "$(dirname "$0")/common.bash"

old_pids=''

all_are_new() {
  local unit pid
  for unit in "${members[@]}"; do
    pid=$(pid_of "$unit")
    ((pid != 0)) && [[ " $old_pids " != *" $pid "* ]] && are_active "$unit" || return 1
  done
}

recover_from() {  # recover_from WORDS COMMAND...: all processes anew, and layers
  local words=$1 start unit
  shift
  old_pids=$(for unit in "${members[@]}"; do pid_of "$unit"; done | tr '\n' ' ')
  start=$(now_ms)
  "$@"
  eventually 20 all_are_new || fail "$words: not everything came back"
  local ready=$(($(now_ms) - start))
  must_see_layers "$words"
  local took=$(($(now_ms) - start))
  say "$words: all are ready after $ready ms, a planner has layers after $took ms"
  ((took < 10000)) || fail "$words: that is too slow"
}

kill_broker() { kill -KILL "$(pid_of gvom-roudi)"; }

hang_broker() { kill -STOP "$(pid_of gvom-roudi)"; }

# As after a process died while it published: the next one to join waits for an answer that never comes.
hang_broker_and_join() {
  hang_broker
  kill -KILL "$(pid_of gvom-fusion)"
}

install_package
use_recording
start_all
must_see_layers "at first"
recover_from "broker killed" kill_broker
recover_from "broker hung" hang_broker
recover_from "broker hung and fusion joining" hang_broker_and_join
systemctl restart gvom-roudi
eventually 20 are_active "${members[@]}" || fail "not all are back after a restart by hand"
must_see_layers "after a restart by hand"
stop_all
say "well"
