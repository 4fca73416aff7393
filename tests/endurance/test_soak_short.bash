#!/usr/bin/env bash
# test_soak_short.bash BUILD: tools/soak for a quarter of a minute in peace and for half a minute with faults.
set -euo pipefail

tools=$(dirname "$(readlink -f "$0")")/../../tools
build=$1
command -v gnuplot > /dev/null || { echo "SKIPPED: no picture of the soak without gnuplot (tools/install-deps --test)"; exit 77; }

soak() {  # soak ARGUMENT...
  "$tools/soak" --build "$build" --processes --round 2 --out /tmp/soak "$@" || { cat /tmp/soak/*.log /tmp/soak/verdict.json; exit 1; }
  [[ $(head -c 4 /tmp/soak/curves.png) == $'\x89PNG' ]] || { echo "FAILED: no picture"; exit 1; }
}

soak --minutes 0.2
soak --minutes 0.4 --faults --fault-every 6
