#!/usr/bin/env bash
# Each process killed at random moments under the load of two lidars at 20 Hz, GVOM_FAULTS_REPEAT times (default 2), and
# stopped for 5 s (gvom-odometry alone, for 2 s, without GVOM_FAULTS_REPEAT; tests/faults stops the rest): the others go on, it comes back, pools are as they were. A row of the table for each.
# shellcheck source=common.bash
source "$(dirname "$0")/common.bash"

repeat=${GVOM_FAULTS_REPEAT:-2} stops=1 stop_s=2
if [[ -n ${GVOM_FAULTS_REPEAT:-} ]]; then stops=$((repeat < 5 ? repeat : 5)) stop_s=5; fi
hangs=0
missed=()
rounds=/tmp/rounds.log

# campaign PROCESS,PROCESS... ROUNDS [SECONDS]: gvom-test-kills, a line for each round. It leaves with 75 when the broker goes: a process
# that dies within a publish may leave it waiting. Then all start again, as designed, and what is left of the rounds follows.
campaign() {
  local processes=$1 left=$2 kinds code broker
  kinds=$(tr ',' '\n' <<< "$processes" | wc -l)
  : > "$rounds"
  while ((left > 0)); do
    code=0 broker=$(pid_of gvom-roudi)
    runuser -u gvom -- gvom-test-kills front,rear "$processes" "$left" "${@:3}" > /tmp/kills.log || code=$?
    cat /tmp/kills.log
    cat /tmp/kills.log >> "$rounds"
    ((code == 75)) || break
    left=$((left - $(grep --count 'well again' /tmp/kills.log || true) / kinds - 1)) hangs=$((hangs + 1))
    eventually 60 is_new_broker "$broker" || fail "the broker hung, and not all are back"
    say "the broker hung and was started again"
  done
  report "$processes" "${3:+stopped for $3 s}"
  if ((code != 0 && code != 75)) || grep --quiet 'NOT WELL' "$rounds"; then missed+=("$processes"); fi  # before a broker's hang, too
}

is_new_broker() { [[ $(pid_of gvom-roudi) != "$1" ]] && are_active "${members[@]}"; }

report() {  # report PROCESS,PROCESS... WORDS: a row for each: the slowest of its rounds
  awk -v processes="$1" -v fault="${2:-killed (kill -9)}" '
    / well again after / {
      name = $1; sub(":", "", name); count[name]++
      for (i = 2; i < NF; i++) {
        if ($(i - 1) == "again" && $i == "after" && $(i + 1) > slowest[name]) slowest[name] = $(i + 1)
        if ($i == "after" && $(i - 1) == "named") { named[name]++; if ($(i + 1) > latest[name]) latest[name] = $(i + 1) }
        if ($i == "paused" && $(i + 1) > pause[name]) pause[name] = $(i + 1)
      }
    }
    END {
      for (i = split(processes, order, ","); i > 0; i--) {
        name = order[i]
        seen = named[name] ? "Layers name it as missing after " latest[name] " s at most" : "layers stop"
        printf "FAULT | %s %s, %d times | %s | %s s at most, until the window is full | its own work meanwhile; the others paused %s s at most |\n", \
          name, fault, count[name], seen, slowest[name], pause[name] + 0
      }
    }' "$rounds"
}

unpack_package
use_test_programs
use_recording
cp "$vehicle" /tmp/replayed.yaml
use_live_vehicle
start_all
live=gvom-fusion,gvom-ingest-front,gvom-ingest-rear
campaign "$live" "$repeat"
[[ -z ${GVOM_FAULTS_REPEAT:-} ]] || campaign "$live" "$stops" "$stop_s"
stop_all
use_replayed_vehicle /tmp/replayed.yaml
start_all
campaign gvom-odometry "$repeat"
campaign gvom-odometry "$stops" "$stop_s"
stop_all
say "the broker hung $hangs times"
((${#missed[@]} == 0)) || fail "not well at times: ${missed[*]}"
say "well"
