#!/usr/bin/env bash
# test_soak_short.bash BUILD: tools/soak for half a minute, with faults. In peace it would want
# nearly every round undisturbed, which other tests beside it may not grant.
set -euo pipefail

tools=$(dirname "$(readlink -f "$0")")/../../tools
build=$1
command -v gnuplot > /dev/null || { echo "SKIPPED: no picture of the soak without gnuplot (tools/install-deps --test)"; exit 77; }

"$tools/soak" --build "$build" --processes --round 2 --out /tmp/soak --minutes 0.6 --faults --fault-every 4 --seed 55 ||
  { cat /tmp/soak/*.log /tmp/soak/verdict.json; exit 1; }
[[ $(head -c 4 /tmp/soak/curves.png) == $'\x89PNG' ]] || { echo "FAILED: no picture"; exit 1; }
