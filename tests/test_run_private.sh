#!/bin/sh
# A clone below /tmp runs its tests: run-private.sh hides /tmp, but neither the clone, nor the recordings beside it,
# nor where it was called from. What else lies in /tmp is hidden.
set -eu

script=$(CDPATH='' cd "$(dirname "$0")" && pwd)/run-private.sh
beside=$(mktemp -d /tmp/gvom-clone.XXXXXX)
other=$(mktemp -d /tmp/gvom-other.XXXXXX)
trap 'rm -rf "$beside" "$other"' EXIT
mkdir -p "$beside/gvom/tests" "$beside/shared" "$beside/called from"
cp "$script" "$beside/gvom/tests/"
cd "$beside/called from"

export beside other  # not as arguments: what these name is carried in
code=0
# shellcheck disable=SC2016  # expanded inside
../gvom/tests/run-private.sh sh -c '[ -x "$beside/gvom/tests/run-private.sh" ] && [ -d "$beside/shared" ] &&
  [ "$PWD" = "$beside/called from" ] && [ ! -e "$other" ]' || code=$?
[ "$code" = 77 ] || [ "$code" = 0 ] || echo "run-private.sh in a clone below /tmp ended with $code" >&2
exit "$code"
