#!/bin/sh
# Builds the page into a folder of static files: build.sh FOLDER
# The sources stay as they are: npm's packages go to FOLDER.build, beside the folder.
set -eu

[ $# -eq 1 ] || { echo "usage: $0 FOLDER" >&2; exit 64; }
source=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1" "$1.build"
out=$(cd "$1" && pwd)
work=$(cd "$1.build" && pwd)

fail() {
  echo "gvom's page cannot be built: $1" >&2
  exit 69
}

command -v node >/dev/null || fail "node is missing (Debian: nodejs, 18 or later)"
command -v npm >/dev/null || fail "npm is missing (Debian: npm)"
version=$(node -p 'process.versions.node.split(".")[0]')
[ "$version" -ge 18 ] || fail "node $version is too old, 18 is needed"

cd "$work"
rm -rf src scripts
for part in package.json package-lock.json .npmrc vite.config.js index.html src scripts; do cp -R "$source/$part" .; done
if ! cmp -s package-lock.json installed.json; then
  rm -f installed.json
  npm ci --omit=dev --no-progress >npm.log 2>&1 || { cat npm.log >&2; fail "npm ci failed: does npm reach its registry?"; }
  cp package-lock.json installed.json
fi
node_modules/.bin/vite build --logLevel warn --outDir "$out" --emptyOutDir
node scripts/licences.js >"$out/LICENSES.txt"
