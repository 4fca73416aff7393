#!/usr/bin/env bash
# test_run.bash BIN: gvom-run runs a graph to the end of its recording, until it is interrupted, until a process dies.
set -euo pipefail

bin=$1
vehicle=$(dirname "$(readlink -f "$0")")/../../config/vehicles/two_lidars.yaml
cd "$(mktemp -d /tmp/gvom-run.XXXXXX)"

failed() {  # failed WORDS...
  cat said ./*/logs/*.log >&2
  echo "FAILED: $*" >&2
  exit 1
}

options=(--config "$vehicle" --set map.size_xy=64 --set bridge.foxglove.port=0)

expect() {  # expect CODE WORDS OUT ARGUMENT...: it ends so, and says that
  local code=0
  "$bin/gvom-run" "${options[@]}" --out "${@:3}" > said 2>&1 || code=$?
  ((code == $1)) || failed "it ended with $code, not with $1: ${*:3}"
  grep -qF "$2" said || failed "it did not say '$2': ${*:3}"
}

begin() {  # begin OUT ARGUMENT...: in the background until it runs; there a shell ignores SIGINT
  : > said
  env --default-signal=INT "$bin/gvom-run" "${options[@]}" --out "$@" > said 2>&1 &
  pid=$!
  until grep -q 'runs (lidars: front rear)' said; do
    kill -0 "$pid" || failed "it did not begin: $*"
    sleep 0.05
  done
}

"$bin/gvom-sim" --config "$vehicle" --out . --seconds 1 > /dev/null
source='front.source=ouster:front.pcap?meta=front.json'

echo "to the end of the recording"
expect 0 'the page: http://127.0.0.1:' whole --rate max
grep -qE '^front +640 +10 +10 ' said || failed "not every sweep was mapped"
[[ -s whole/summary.json ]] || failed "no figures"

echo "the bag is of the sources that leave it open"
expect 65 "it's not.mcap" bag --no-bridge --bag "$(touch "it's not.mcap"; echo "it's not.mcap")" --set "lidars.$source" \
  --set 'lidars.rear.source=bag:?topic=/points'
expect 78 'no source of the vehicle' unused --bag "it's not.mcap"
expect 64 'nowhere' none --bag nowhere

echo "with odometry of somebody else, and without a page"
for try in 1 2 3 4 5; do
  begin "alone$try" --set 'odometry.source=' --set 'bridge.foxglove.address=' --set bridge.mcap.folder=recorded
  kill -INT "$pid"
  wait "$pid" || failed "with odometry of somebody else it ended with $?"
  grep -qF 'somebody else publishes it' said || failed "it did not say that odometry is missing"
done

echo "until it is interrupted"
begin looped --loop
until grep -qE '[0-9] layers' said; do  # gvom-summary listens
  kill -0 "$pid" || failed "it ended before layers came"
  sleep 0.05
done
kill -INT "$pid"
wait "$pid" || failed "interrupted it ended with $?"
grep -q '^process .*CPU' said || failed "it said nothing of what came of the run"

echo "until a process dies"  # and nothing of the last run is in the way
begin killed --loop
kill -KILL "$(pgrep --parent "$pid" --full -- '--lidar rear')"
if wait "$pid"; then failed "it ended well"; fi
grep -qF 'gvom-ingest-rear ended with exit code 137' said || failed "it did not say what died"
! pgrep --full --list-full "^$bin/gvom-.*port=0" > said || failed "it left a process behind"
