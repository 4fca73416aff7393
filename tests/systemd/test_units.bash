#!/usr/bin/env bash
# The units as systemd reads them: no unknown key, little exposure, what real time needs, the drop-ins of the README; and the bridge's at work.
# shellcheck source=common.bash
source "$(dirname "$0")/common.bash"
# shellcheck source=bridge.bash
source "$(dirname "$0")/bridge.bash"

units=(gvom-roudi.service gvom-fusion.service gvom-ingest@front.service gvom-odometry.service gvom-planner.service
  gvom-bridge.service gvom-metrics.service)

expect() {  # expect UNIT PROPERTY VALUE
  [[ $(property "$1" "$2") == "$3" ]] || fail "$1: $2 is $(property "$1" "$2"), not $3"
}

check_unit() {
  local exposure
  systemd-analyze verify --recursive-errors=one "$1" || fail "$1: systemd-analyze verify"
  exposure=$(systemd-analyze security --offline=true --threshold=30 --no-pager "$1") || fail "$1: too exposed: $exposure"
  say "$1: $(grep -oE 'exposure level.*: [0-9.]+' <<< "$exposure")"
  expect "$1" LimitMEMLOCK infinity
  expect "$1" RemoveIPC no
  expect "$1" PrivateTmp no
  expect "$1" User gvom
  expect "$1" Group gvom
}

# The examples of systemd/README.md, as they stand there: ```ini blocks, each headed by its file's name.
use_examples() {
  awk -v folder=/etc/systemd/system '
    /^```ini/ { inside = 1; next }
    /^```/ { inside = 0; file = "" }
    inside && /^# \/etc\/systemd\/system\// { file = $2; system("mkdir -p $(dirname " file ")") }
    inside && file != "" { print > file; if (!(file in seen)) { seen[file] = 1; print file > "/dev/stderr" } }
  ' /usr/share/doc/gvom/systemd.md
  systemctl daemon-reload
}

unpack_package
use_small_map
for unit in "${units[@]}"; do check_unit "$unit"; done
systemd-analyze verify gvom.target || fail "gvom.target"
use_examples
for unit in "${units[@]}"; do systemd-analyze verify --recursive-errors=one "$unit" || fail "$unit with the README's drop-ins"; done
expect gvom-fusion.service CPUSchedulingPolicy 1
expect gvom-fusion.service CPUSchedulingPriority 20
expect gvom-ingest@front.service CPUSchedulingPolicy 1
expect gvom-fusion.service PrivateDevices no
exposure=$(systemd-analyze security --offline=true --threshold=30 --no-pager gvom-fusion.service) || fail "fusion with a GPU is too exposed"
say "fusion with a GPU: $(grep -oE 'exposure level.*: [0-9.]+' <<< "$exposure")"
rm /etc/systemd/system/gvom-odometry.service.d/once.conf  # the bridge is to have something to send as long as it takes
use_patience
use_recording
use_bridge
start_all
must_see_layers "with the README's drop-ins"
[[ $(chrt --pid "$(pid_of gvom-fusion)") == *SCHED_FIFO*priority:\ 20* ]] || fail "fusion is not scheduled fifo: $(chrt --pid "$(pid_of gvom-fusion)")"
check_bridge
say "well"
