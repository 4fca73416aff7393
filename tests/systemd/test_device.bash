#!/usr/bin/env bash
# A GPU that fails whenever it is used, under `auto`: three restarts, then fusion stays, on the CPU, and says so; a
# minute later a restart tries the GPU again. What it remembers it can write in spite of the units' restrictions.
# shellcheck source=common.bash
source "$(dirname "$0")/common.bash"

record=/tmp/gvom-fusion.device-failures
why="the GPU failed 3 times within a minute"

use_failing_device() {  # fusion on the tests' device, which is lost soon after each start
  local folder=/etc/systemd/system/gvom-fusion.service.d
  install "$GVOM_BIN/gvom-fusion-serial" /usr/local/bin
  mkdir -p "$folder"
  printf '%s\n' '[Service]' Environment=GVOM_SERIAL_DEVICE_FAIL_AT=400 ExecStart= \
    "ExecStart=/usr/local/bin/gvom-fusion-serial --config $vehicle" > "$folder/test.conf"
  echo 'fusion: {backend: auto}' >> "$vehicle"
  systemctl daemon-reload
}

says_why() {
  gvomctl status --config "$vehicle" > /tmp/status 2>&1 || true  # 1: something is not well
  grep --quiet "! gvom-fusion is degraded: $why" /tmp/status
}

starts_on() { journalctl --unit gvom-fusion --output cat | grep --count "fusing 2 lidars on $1: " || true; }

has_started() { [[ $(starts_on cuda) == "$1" && $(starts_on cpu) == "$2" ]]; }

must_stay_on_cpu() {  # must_stay_on_cpu CUDA_STARTS CPU_STARTS: of all since the first
  eventually 120 says_why || fail "fusion does not say that the CPU stands in: $(cat /tmp/status)"
  eventually 60 has_started "$@" || fail "started $(starts_on cuda) times on the device, $(starts_on cpu) on the CPU"
  sleep 2
  has_started "$@" || fail "then started $(starts_on cuda) times on the device, $(starts_on cpu) on the CPU"
  must_see_layers "on the CPU"
  say "on the CPU after $(starts_on cuda) starts on the device"
}

date_failures() {  # date_failures SECONDS: as if all had been so long ago
  awk -v ago="$1" -v now="$(cut --delimiter ' ' --fields 1 /proc/uptime)" \
    'NR > 1 { $1 = sprintf("%.0f", (now - ago) * 1e9) } { print }' "$record" > /tmp/dated
  install --owner gvom --group gvom --mode 600 /tmp/dated "$record"
}

unpack_package
use_small_map
use_patience
use_recording
use_failing_device
start_all
must_stay_on_cpu 3 1
[[ $(stat --format '%U %a' "$record") == "gvom 600" ]] || fail "the record is not the services' own: $(stat "$record")"
date_failures 0  # so far it may have taken a minute
kill -KILL "$(pid_of gvom-fusion)"
must_stay_on_cpu 3 2

date_failures 61  # more than a minute
systemctl restart gvom-fusion
must_stay_on_cpu 6 3
say "well"
