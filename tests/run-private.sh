#!/bin/sh
# run-private.sh COMMAND [ARGUMENT]...
# Runs COMMAND with a /dev/shm and a /tmp of its own, so that it may start a broker. Works as root and, where
# user namespaces are allowed, as anybody. What lies below /tmp and is needed (the repository, the command, the
# working directory, the recordings) stays where it was. Exits with 77 where the system does not allow it.
set -eu

if [ "${GVOM_PRIVATE:-}" != inside ]; then
  as_root=
  [ "$(id -u)" = 0 ] || as_root=--map-root-user
  if ! unshare --mount $as_root true 2>/dev/null; then
    echo "SKIPPED: no private mount namespace here (unshare --mount $as_root is refused), so no test with a broker" >&2
    exit 77
  fi
  GVOM_PRIVATE=inside exec unshare --mount --propagation private $as_root "$0" "$@"
fi
unset GVOM_PRIVATE

here=$(CDPATH='' cd "$(dirname "$0")/.." && pwd)  # before /tmp is hidden: it may lie there
mount -t tmpfs tmpfs /dev/shm
mkdir /dev/shm/outer
mount --rbind /tmp /dev/shm/outer
mount -t tmpfs tmpfs /tmp
chmod 1777 /tmp /dev/shm
for path in "$here" "${here%/*}/shared" "$PWD" "${GVOM_SHARED:-}" "$@"; do
  case $path in
    /tmp/*)
      entry=${path#/tmp/}
      entry=${entry%%/*}
      if [ -d "/dev/shm/outer/$entry" ] && [ ! -e "/tmp/$entry" ]; then
        mkdir "/tmp/$entry"
        mount --rbind "/dev/shm/outer/$entry" "/tmp/$entry"
      fi
      ;;
  esac
done
umount -l /dev/shm/outer
rmdir /dev/shm/outer
cd "$PWD"
exec "$@"
