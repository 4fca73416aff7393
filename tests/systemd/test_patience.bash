#!/usr/bin/env bash
# The broker fails in the middle of its start, again and again, is refused for seconds on a running stack, at boot:
# once the cause is gone all is back, with no hand on it, and nobody was started more often than needed.
# shellcheck source=common.bash
source "$(dirname "$0")/common.bash"

most_ms=60000  # on a busy machine that pauses; 5 s otherwise

must_be_back() {  # must_be_back WORDS: from now
  local begin
  begin=$(now_ms)
  eventually 60 are_active "${members[@]}" || fail "$*: not everything came back"
  must_see_layers "$*"
  local took=$(($(now_ms) - begin))
  say "$*: all are back after $took ms"
  ((took < most_ms)) || fail "$*: that is too slow"
}

put_in_the_way() { install --mode 600 /dev/null "$1"; }  # root's, where the broker wants its own

is_refused() { [[ $(property gvom-roudi ExecMainStatus) == 69 ]]; }

waits() { [[ $(property "$1" StatusText) == "waiting for the broker"* && $(property "$1" ActiveState) == activating ]]; }

restarts() { for unit in "${members[@]:1}"; do property "$unit" NRestarts; done; }

check_boot() {
  local begin before unit
  put_in_the_way /tmp/roudi.lock
  begin=$(now_ms)
  systemctl start gvom.target
  say "systemctl start gvom.target returns after $(($(now_ms) - begin)) ms, without a broker"
  (($(now_ms) - begin < 30000)) || fail "systemctl start gvom.target blocks"
  eventually 60 is_refused || fail "gvom-roudi is not refused"
  for unit in "${members[@]:1}"; do
    eventually 60 waits "$unit" || fail "$unit does not wait for the broker: $(property "$unit" StatusText)"
  done
  before=$(restarts)
  sleep 2.5  # two more tries of the broker
  [[ $(restarts) == "$before" ]] || fail "others are started again with each try of the broker"
  rm /tmp/roudi.lock
  must_be_back "refused at boot"
}

check_running() {  # check_running FILE
  local pid
  pid=$(pid_of gvom-roudi)
  put_in_the_way "$1.others"
  kill -STOP "$pid"  # the next one is to find it: not before the file is there does this one end
  mv "$1.others" "$1"
  kill -KILL "$pid"
  eventually 60 is_refused || fail "gvom-roudi is not refused because of $1"
  sleep 2.5
  rm "$1"
  must_be_back "refused for 3 s because of $1"
}

is_starting_anew() {  # is_starting_anew OLD_PID
  local pid
  pid=$(pid_of gvom-roudi)
  ((pid != 0 && pid != $1))
}

check_kills() {  # check_kills TIMES: each within the start after the one before
  local i pid
  for ((i = 0; i < $1; i++)); do
    pid=$(pid_of gvom-roudi)
    kill -KILL "$pid"
    eventually 60 is_starting_anew "$pid" || fail "the broker is not started again"
  done
  must_be_back "the broker killed $1 times, within its own start"
}

check_stop() {  # by hand: it stays so, and the others wait
  systemctl stop gvom-roudi
  for unit in "${members[@]:1}"; do eventually 60 waits "$unit" || fail "$unit does not wait for a broker that was stopped"; done
  [[ $(property gvom-roudi ActiveState) == inactive ]] || fail "a broker that was stopped by hand is $(property gvom-roudi ActiveState)"
  systemctl start gvom-roudi
  must_be_back "the broker stopped and started by hand"
}

unpack_package
use_small_map
use_patience
use_recording
check_boot
check_kills 2
check_kills 3
check_running /tmp/roudi.lock
check_running /tmp/roudi
check_stop
stop_all
say "well"
