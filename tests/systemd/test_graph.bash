#!/usr/bin/env bash
# A fresh system: the package, its README's steps, layers; the clock set; everything stopped.
# shellcheck source=common.bash
source "$(dirname "$0")/common.bash"

# The package of 0.2 had /etc/gvom/vehicle.yaml as a conffile; whoever changed it is not asked, and keeps it.
install_old_package() {
  mkdir -p /tmp/old/DEBIAN /tmp/old/etc/gvom
  printf '%s\n' 'Package: gvom' 'Version: 0.2.0' 'Architecture: amd64' 'Maintainer: nobody <nobody@localhost>' \
    'Description: gvom of before, no more than its conffile' > /tmp/old/DEBIAN/control
  echo "$vehicle" > /tmp/old/DEBIAN/conffiles
  cp "$(dirname "$0")/../../config/vehicles/two_lidars.yaml" "/tmp/old$vehicle"
  dpkg-deb --build --root-owner-group /tmp/old /tmp/old.deb > /dev/null
  dpkg --force-unsafe-io --install /tmp/old.deb > /tmp/dpkg.log 2>&1 || { cat /tmp/dpkg.log; fail "dpkg: 0.2"; }
  echo '# the administrator was here' >> "$vehicle"
}

check_install() {
  grep --quiet 'the administrator was here' "$vehicle" || fail "an upgrade from 0.2 takes the vehicle's file"
  [[ ! -e $vehicle.dpkg-new && ! -e $vehicle.dpkg-dist && ! -e $vehicle.dpkg-bak ]] || fail "an upgrade from 0.2 leaves copies of the vehicle's file"
  [[ $(systemctl is-enabled gvom.target || true) == disabled ]] || fail "the package enabled something"
  id gvom > /dev/null || fail "no user gvom"
  [[ $(stat --format %U:%G /var/lib/gvom) == gvom:gvom ]] || fail "/var/lib/gvom"
  gvom-fusion --config "$vehicle" --check || fail "$vehicle"
}

check_running() {
  local unit
  for unit in "${members[@]}"; do
    [[ $(ps --no-headers --format user:32,group:32 --pid "$(pid_of "$unit")" | tr -s ' ') == "gvom gvom"* ]] || fail "$unit: its user"
    [[ -n $(property "$unit" StatusText) ]] || fail "$unit: no status"
    say "$unit: $(property "$unit" StatusText)"
  done
}

metrics() {
  exec 3<> /dev/tcp/127.0.0.1/9464
  printf 'GET /metrics HTTP/1.0\r\n\r\n' >&3
  cat <&3
}

check_tools() {
  eventually 60 gvomctl status > /tmp/status.log 2>&1 || { cat /tmp/status.log; fail "gvomctl status"; }
  tail -n 20 /tmp/status.log
  systemctl start gvom-metrics || fail "gvom-metrics"
  metrics 2> /dev/null | grep --quiet '^gvom_' || fail "no figures at 127.0.0.1:9464/metrics"
}

is_back() {  # is_back UNIT OLD_PID
  local pid
  pid=$(pid_of "$1")
  ((pid != 0 && pid != $2)) && are_active "$1"
}

# A wall clock that the test sets, for these units alone: all that read it or wait by it.
set_clock() {  # set_clock SECONDS_AHEAD
  perl -e 'print pack("q", $ARGV[0])' -- "$1" | dd of=/tmp/gvom-clock conv=notrunc status=none
}

use_clock() {
  install --mode 644 "$GVOM_CLOCK" /usr/local/lib/clock_step.so
  set_clock 0
  chmod 644 /tmp/gvom-clock
  mkdir -p /etc/systemd/system/gvom-.service.d
  printf '%s\n' '[Service]' 'Environment=LD_PRELOAD=/usr/local/lib/clock_step.so GVOM_CLOCK_STEP=/tmp/gvom-clock' \
    > /etc/systemd/system/gvom-.service.d/clock.conf
  systemctl daemon-reload
}

check_clock() {  # set while all runs: nobody minds
  local ahead_s unit
  for ahead_s in 3600 -3600; do
    set_clock "$ahead_s"
    sleep 6  # the watchdogs have 5 s
    must_see_layers "the clock is $ahead_s s ahead"
  done
  for unit in "${members[@]}"; do
    [[ $(property "$unit" NRestarts) == 0 ]] || fail "$unit was restarted when the clock was set"
  done
  say "the clock was set by an hour and by two: nobody minds"
}

no_process() { ! pgrep --uid gvom > /dev/null; }

broker_stopped_last() {  # broker_stopped_last SINCE
  journalctl --since "$1" --output cat | grep -E '^Stopped gvom' | tail -n 1 | grep --quiet gvom-roudi
}

check_stop() {
  local started
  started=$(date '+%F %T')
  sleep 1  # journalctl's --since is of whole seconds
  say "stopping gvom.target"
  stop_all
  for unit in "${members[@]}"; do
    [[ $(property "$unit" Result) == success ]] || fail "$unit ended with $(property "$unit" Result)"
  done
  if journalctl --since "$started" --unit 'gvom*' --output cat | grep -iE 'abort|cannot go on|SIGKILL|timed out|core'; then
    fail "the stop was not clean"
  fi
  [[ ! -e /dev/shm/gvom && ! -e /dev/shm/iceoryx_mgmt && ! -e /dev/shm/gvom_doorbell ]] || fail "shared memory is left"
  eventually 60 broker_stopped_last "$started" || fail "the broker was not the last to stop"
}

is_new_broker() { is_back gvom-roudi "$1" && are_active "${members[@]}"; }

check_upgrade() {
  local pid
  systemctl start gvom.target
  pid=$(pid_of gvom-roudi)
  install_package  # again, while it runs
  eventually 60 is_new_broker "$pid" || fail "after an upgrade not everything was started again"
}

# Who starts the services one by one has none of them run on with the old program.
check_upgrade_without_target() {
  local broker fusion
  systemctl stop gvom.target 'gvom-*.service'
  systemctl start gvom-roudi gvom-fusion
  broker=$(pid_of gvom-roudi) fusion=$(pid_of gvom-fusion)
  install_package
  eventually 60 is_back gvom-roudi "$broker" || fail "after an upgrade the broker, started without the target, was not started again"
  eventually 60 is_back gvom-fusion "$fusion" || fail "after an upgrade fusion, started without the target, was not started again"
  ! systemctl --quiet is-active gvom.target || fail "an upgrade starts the target"
}

check_removal() {
  say "removing the package while it runs"
  dpkg --purge gvom > /tmp/dpkg.log 2>&1 || { cat /tmp/dpkg.log; fail "dpkg --purge"; }
  eventually 60 no_process || fail "processes are left: $(pgrep --uid gvom --list-full)"
  [[ -z $(find /tmp /dev/shm -maxdepth 1 -user gvom ! -type d) ]] || fail "files of the bus are left"
  grep --quiet 'gvom: /var/lib/gvom is left' /tmp/dpkg.log || { cat /tmp/dpkg.log; fail "purge does not say what it leaves"; }
  [[ ! -e $vehicle && ! -e /usr/lib/systemd/system/gvom.target && ! -e /etc/systemd/system/gvom.target.wants ]] || fail "files are left"
}

rm -f /usr/sbin/policy-rc.d  # in a container's image it forbids packages to restart anything
install_old_package
install_package
check_install
use_patience
use_recording
use_clock
start_all
must_see_layers "at first"
check_running
check_clock
check_tools
check_stop
check_upgrade
check_upgrade_without_target
systemctl start gvom.target
check_removal
say "well"
