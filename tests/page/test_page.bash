#!/usr/bin/env bash
# Builds the page and runs its tests: test_page.bash FOLDER. Packages of npm stay in FOLDER.
set -euo pipefail

source=$(dirname "$(readlink -f "$0")")/../../services/bridge/page
folder=$1

skip() {
  echo "SKIPPED: the page's tests: $1"
  exit 77
}

for program in node npm chromium; do command -v "$program" > /dev/null || skip "$program is not here"; done
mkdir -p "$folder"
cd "$folder"
rm -rf src mock test scripts dist
cp -R "$source"/. .
if ! cmp -s package-lock.json installed.json; then
  npm ci --no-progress > npm.log 2>&1 || { tail -n 5 npm.log; skip "npm ci failed"; }
  cp package-lock.json installed.json
fi
npm test
npm run build
npm run test:browser
