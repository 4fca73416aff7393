#!/usr/bin/env bash
# The broker dies, hangs, is restarted: everything is back with no hand on it. A live vehicle at 20 Hz, which is a planner too,
# tells when it has layers again, and when their window is full. GVOM_FAULTS_REPEAT times (default 1), all but the kills at most 20
# times; a row of the table for each.
# shellcheck source=common.bash
source "$(dirname "$0")/common.bash"

repeat=${GVOM_FAULTS_REPEAT:-1}
few=$((repeat < 20 ? repeat : 20))
most_ms=40000  # on a busy machine that pauses
if [[ -n ${GVOM_FAULTS_REPEAT:-} ]]; then most_ms=5000; fi
hang_tries=60
old_pids=''

all_are_new() {
  local unit pid
  for unit in "${members[@]}"; do
    pid=$(pid_of "$unit")
    ((pid != 0)) && [[ " $old_pids " != *" $pid "* ]] && are_active "$unit" || return 1
  done
}

is_back() { [[ -e /tmp/gvom-test/window ]] && (($(cat /tmp/gvom-test/window) > fault_ms)) && all_are_new; }

recover_from() {  # recover_from COMMAND...: it sets `fault_ms`; all processes anew, and layers
  eventually 60 are_active "${members[@]}" || fail "$*: not everything runs"
  rm -f /tmp/gvom-test/{layers,window}  # a vehicle writes each but once: what comes is of a new one
  old_pids=$(for unit in "${members[@]}"; do pid_of "$unit"; done | tr '\n' ' ')
  fault_ms=$(now_ms)
  "$@"
  eventually 60 is_back || fail "$*: not everything came back"
  layers_ms=$(($(cat /tmp/gvom-test/layers) - fault_ms)) window_ms=$(($(cat /tmp/gvom-test/window) - fault_ms))
  say "$*: a planner has layers after $layers_ms ms, of a full window after $window_ms ms"
  ((layers_ms < most_ms)) || fail "$*: that is too slow"
  sleep 0.3
}

kill_broker() { kill -KILL "$(pid_of gvom-roudi)"; }

stop_broker() { kill -STOP "$(pid_of gvom-roudi)"; }

# And a process joins meanwhile: it waits for an answer that never comes.
stop_broker_and_kill_fusion() {
  stop_broker
  kill -KILL "$(pid_of gvom-fusion)"
}

is_another_broker() { [[ $(pid_of gvom-roudi) != "$1" ]]; }

restart_broker() { systemctl restart --no-block gvom-roudi; }

# A process that dies within a publish leaves a lock behind that the broker then waits for.
hang_broker() {
  local broker
  broker=$(pid_of gvom-roudi)
  while true; do
    if ! runuser -u gvom -- gvom-test-hang "$hang_tries" > /tmp/hang.log; then
      echo "SKIPPED: in $hang_tries kills within a publish the broker did not hang"
      exit 77
    fi
    if eventually 10 is_another_broker "$broker"; then break; fi  # else the machine paused, and the broker lives
  done
  read -r fault_ms rest < /tmp/hang.log
  say "the broker hangs $rest"
}

check() {  # check SEEN COMMAND TIMES, then a row
  local i slowest=0 full=0
  for ((i = 0; i < $3; i++)); do
    recover_from "$2"
    ((layers_ms > slowest)) && slowest=$layers_ms
    ((window_ms > full)) && full=$window_ms
  done
  printf 'FAULT | %s, %d times | layers stop | %d.%02d s at most; %d.%02d s until the window is full | the window |\n' "$1" "$3" \
    $((slowest / 1000)) $((slowest % 1000 / 10)) $((full / 1000)) $((full % 1000 / 10))
}

unpack_package
use_test_programs
use_recording
use_live_vehicle
start_all
eventually 60 test -e /tmp/gvom-test/window || fail "no layers came at first"
check "gvom-roudi killed" kill_broker "$repeat"
check "gvom-roudi stopped (SIGSTOP)" stop_broker "$few"
check "gvom-roudi stopped, gvom-fusion killed" stop_broker_and_kill_fusion "$few"
check "systemctl restart gvom-roudi" restart_broker "$few"
check "gvom-roudi hung by a kill -9 within a publish" hang_broker "$few"
stop_all
say "well"
