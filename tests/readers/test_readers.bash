#!/usr/bin/env bash
# Installs Foxglove's readers from npm into FOLDER and runs the test with them: test_readers.bash FOLDER PROGRAM.
set -euo pipefail

source=$(dirname "$(readlink -f "$0")")
folder=$1
program=$2

skip() {
  echo "SKIPPED: Foxglove's readers: $1"
  exit 77
}

for needed in node npm; do command -v "$needed" > /dev/null || skip "$needed is not here"; done
mkdir -p "$folder"
cp "$source"/*.js "$source"/package*.json "$folder"
cd "$folder"
if ! cmp -s package-lock.json installed.json; then
  npm ci --no-progress > npm.log 2>&1 || { tail -n 5 npm.log; skip "npm ci failed"; }
  cp package-lock.json installed.json
fi
GVOM_READERS=$folder exec "$source/../run-private.sh" "$program"
