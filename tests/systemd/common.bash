# What the tests under a systemd share. They run as root in under-systemd, with the package (GVOM_PACKAGE) and a
# recording (GVOM_RECORDING), and end at the first thing that is not as it should be.
# shellcheck shell=bash
set -euo pipefail

members=(gvom-roudi gvom-fusion gvom-ingest@front gvom-ingest@rear gvom-odometry)
vehicle=/etc/gvom/vehicle.yaml

# What the machine's own broker left; it is seen here, but stays there.
find /tmp -maxdepth 1 -not -type d \( -name 'roudi*' -o -name 'iox-*' -o -name 'gvom-*' \) -delete

say() { printf '== %3d s: %s\n' "$SECONDS" "$*"; }

fail() {
  printf 'FAILED: %s\n' "$*"
  systemctl --no-pager --lines 0 status 'gvom*' || true
  journalctl --no-pager --lines 40 --output short-precise || true
  exit 1
}

now_ms() { echo $(($(date +%s%N) / 1000000)); }

eventually() {  # eventually SECONDS COMMAND...: until the command says yes. The time is that of a machine that is busy and pauses
  local end=$(($(now_ms) + $1 * 1000))
  shift
  until "$@"; do
    (($(now_ms) < end)) || return 1
    sleep 0.05
  done
}

property() { systemctl show --property "$2" --value "$1"; }  # property UNIT NAME

pid_of() { property "$1" MainPID; }

are_active() { systemctl is-active --quiet "$@"; }

has_said() { journalctl --unit "$1" --output cat | grep --quiet --fixed-strings -- "$2"; }  # has_said UNIT WORDS

install_package() {
  [[ -e $GVOM_PACKAGE ]] || { echo "SKIPPED: there is no package to install"; exit 77; }
  say "installing $(basename "$GVOM_PACKAGE")"
  dpkg --force-unsafe-io --install "$GVOM_PACKAGE" > /tmp/dpkg.log 2>&1 || { cat /tmp/dpkg.log; fail "dpkg"; }
}

unpack_package() {  # the same, without dpkg's bookkeeping, which takes seconds
  [[ -e $GVOM_PACKAGE ]] || { echo "SKIPPED: there is no package to install"; exit 77; }
  dpkg-deb --extract "$GVOM_PACKAGE" /
  dpkg-deb --control "$GVOM_PACKAGE" /tmp/control
  /tmp/control/postinst configure
}

use_small_map() {  # less memory for the broker to write
  echo 'map: {size_xy: 128, size_z: 32}' >> "$vehicle"
}

# Where the broker's watchdog and the end of a stop are not what is tested: a pause of the machine is no hang.
use_patience() {
  local folder=/etc/systemd/system
  mkdir -p "$folder"/gvom-{,roudi}.service.d
  printf '%s\n' '[Service]' WatchdogSec=5 > "$folder/gvom-roudi.service.d/patience.conf"  # as of all others
  printf '%s\n' '[Service]' TimeoutStopSec=20 > "$folder/gvom-.service.d/patience.conf"
  systemctl daemon-reload
}

use_recording() {  # over and over again, as gvom-odometry.service does
  cp "$GVOM_RECORDING"/* /var/lib/gvom/
  systemctl daemon-reload
  systemctl --quiet enable gvom-ingest@front gvom-ingest@rear gvom-odometry
}

# Its sensors send to ports, at 20 Hz (among other tests at 10, of the same turns); it publishes its own odometry, and reads the layers.
use_live_vehicle() {
  local turn_ms=50
  if [[ -z ${GVOM_FAULTS_REPEAT:-} ]]; then
    turn_ms=100
    sed --in-place 's/1024x20/1024x10/' /var/lib/gvom/*.json
  fi
  members=(gvom-roudi gvom-fusion gvom-ingest@front gvom-ingest@rear gvom-test-vehicle)
  install --owner gvom --directory /tmp/gvom-test
  sed --in-place --expression 's|ouster:front.pcap|"ouster-udp:7502|; s|ouster:rear.pcap|"ouster-udp:7503|' \
    --expression 's|meta=.*.json|&"|' "$vehicle"
  printf '%s\n' '[Unit]' PartOf=gvom.target After=gvom-roudi.service \
    '[Service]' Type=notify 'ExecStart=/usr/local/bin/gvom-test-vehicle /var/lib/gvom /tmp/gvom-test front:7502 rear:7503' \
    Environment=GVOM_TURN_MS="$turn_ms" Restart=always TimeoutStopSec=1 '[Install]' WantedBy=gvom.target > /etc/systemd/system/gvom-test-vehicle.service
  systemctl --quiet disable gvom-odometry
  systemctl daemon-reload
  systemctl --quiet enable gvom-test-vehicle
}

use_replayed_vehicle() {  # use_replayed_vehicle FILE: again, with the configuration of before
  members=(gvom-roudi gvom-fusion gvom-ingest@front gvom-ingest@rear gvom-odometry)
  cp "$1" "$vehicle"
  cp "$GVOM_RECORDING"/*.json /var/lib/gvom/
  systemctl --quiet disable gvom-test-vehicle
  systemctl --quiet enable gvom-odometry
}

use_test_programs() {  # where the services' user finds them
  install "$GVOM_BIN"/gvom-test-{vehicle,kills,hang} /usr/local/bin
}

start_all() {
  say "starting gvom.target"
  systemctl start gvom.target
  eventually 60 are_active "${members[@]}" || fail "not all units are active"
}

stop_all() {  # as the README says it: waits for all
  systemctl stop gvom.target 'gvom-*' || fail "systemctl stop"
  if pgrep --uid gvom --list-full; then fail "processes are left"; fi
}

layers_come() {  # who joins a broker that hangs or dies just then waits for a minute: hence timeout
  rm -rf /tmp/pictures
  timeout 20 gvom-snapshot --config "$vehicle" --once --out /tmp/pictures > /tmp/snapshot.log 2>&1
}

must_see_layers() {
  eventually 60 layers_come || { cat /tmp/snapshot.log; fail "no layers came: $*"; }
}
