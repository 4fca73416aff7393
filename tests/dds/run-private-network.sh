#!/bin/sh
# run-private-network.sh COMMAND [ARGUMENT]...
# Runs COMMAND in a network of its own, which has nothing but a loopback that does multicast: no peer elsewhere
# hears it, or is heard. Works as root and, where user namespaces are allowed, as anybody. Exits with 77 where the
# system does not allow it.
set -eu

if [ "${GVOM_PRIVATE_NETWORK:-}" != inside ]; then
  as_root=
  [ "$(id -u)" = 0 ] || as_root=--map-root-user
  # shellcheck disable=SC2086  # empty for root
  if ! unshare --net $as_root true 2>/dev/null; then
    echo "SKIPPED: no private network namespace here (unshare --net $as_root is refused), so no test with DDS peers" >&2
    exit 77
  fi
  # shellcheck disable=SC2086
  GVOM_PRIVATE_NETWORK=inside exec unshare --net $as_root "$0" "$@"
fi
unset GVOM_PRIVATE_NETWORK

ip link set lo up multicast on
ip route add 224.0.0.0/4 dev lo
exec "$@"
