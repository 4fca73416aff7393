#!/usr/bin/env bash
# Another configuration on a running stack: only whom it concerns is restarted, a file that does not load changes nothing,
# also at an upgrade, and who is asked says why something does not run.
# shellcheck source=common.bash
source "$(dirname "$0")/common.bash"

pids() { for unit in "${members[@]}"; do echo "$unit $(pid_of "$unit")"; done; }

set_key() { sed --in-place "/^$1:/d" "$vehicle"; echo "$1: $2" >> "$vehicle"; }

must_say() {  # must_say WORDS FILE
  grep --quiet --fixed-strings -- "$1" "$2" || { cat "$2"; fail "nobody says: $1"; }
}

status_says() {  # status_says WORDS: it ends with 1 where not all is well
  gvomctl status > /tmp/status.log 2>&1 || true
  grep --quiet --extended-regexp -- "$1" /tmp/status.log
}

must_tell() {  # must_tell WORDS: the status does
  eventually 60 status_says "$1" || { cat /tmp/status.log; fail "status does not say: $1"; }
}

must_restart() {  # must_restart WORDS UNIT...: the new ones among the members are these, and all are well
  local words=$1 unit before
  before=$(pids)
  shift
  gvomctl reload > /tmp/reload.log 2>&1 || { cat /tmp/reload.log; fail "gvomctl reload: $words"; }
  is_new() { [[ $'\n'"$before"$'\n' != *$'\n'"$1 $(pid_of "$1")"$'\n'* ]] && are_active "$1"; }
  for unit in "$@"; do eventually 60 is_new "$unit" || { cat /tmp/reload.log; fail "$words: $unit is not restarted"; }; done
  for unit in "${members[@]}"; do
    if [[ " $* " != *" $unit "* ]] && is_new "$unit"; then cat /tmp/reload.log; fail "$words: $unit is restarted"; fi
  done
  eventually 60 gvomctl status > /tmp/status.log 2>&1 || { cat /tmp/status.log; fail "$words: not well"; }
  say "$words: restarted: $*"
}

check_hangup() {
  local before unit
  before=$(pids)
  systemctl kill --signal HUP 'gvom-*'
  for unit in "${members[@]}"; do
    eventually 60 has_said "$unit" "SIGHUP: the configuration is not read again" || fail "$unit says nothing of SIGHUP"
  done
  [[ $(pids) == "$before" ]] || fail "SIGHUP ends somebody"
}

check_broken_file() {
  local before code=0
  before=$(pids)
  cp "$vehicle" /tmp/good.yaml
  set_key layers '{no_such_key: 1}'
  gvomctl reload > /tmp/reload.log 2>&1 || code=$?
  [[ $code == 78 ]] || fail "gvomctl reload of a broken file ends with $code"
  must_say "no_such_key" /tmp/reload.log
  must_say "nothing was changed" /tmp/reload.log
  systemctl reload gvom.target || true
  code=0
  gvomctl status > /tmp/status.log 2>&1 || code=$?
  [[ $code == 1 ]] || fail "gvomctl status with a broken file ends with $code"
  must_say "the vehicle's file does not load" /tmp/status.log
  must_tell '^gvom-ingest-rear +ok'  # it sees what runs
  /tmp/control/postinst configure 0.2.0 > /tmp/postinst.log 2>&1 || fail "postinst with a broken file"
  must_say "NOT RESTARTED" /tmp/postinst.log
  must_say "no_such_key" /tmp/postinst.log
  [[ $(pids) == "$before" ]] || fail "a broken file restarts somebody"
  kill -KILL "$(pid_of gvom-fusion)"
  eventually 60 has_failed gvom-fusion || fail "gvom-fusion runs with a broken file"
  must_tell "gvom-fusion.service failed with exit code 78: $vehicle"
  cp /tmp/good.yaml "$vehicle"
  say "a broken file changes nothing, and everybody says so"
  must_restart "mended" gvom-fusion
}

has_failed() { [[ $(systemctl is-failed "$1") == failed ]]; }

# No vehicle's file asks for the bridge: who started it wants to know all the same.
check_by_choice() {
  cp "$vehicle" /tmp/good.yaml
  set_key bridge '{mcap: {topics: /no/such/topic}}'
  systemctl start gvom-bridge || true
  eventually 60 has_failed gvom-bridge || fail "gvom-bridge runs with a topic that there is not"
  gvomctl status > /tmp/status.log 2>&1 && fail "status is well with a bridge that failed"
  must_tell "gvom-bridge.service failed with exit code 78"
  cp /tmp/good.yaml "$vehicle"
  must_restart "a bridge that had failed"
  eventually 60 are_active gvom-bridge || fail "reload does not start a bridge that had failed"
  systemctl stop gvom-bridge
}

check_not_enabled() {
  cp "$vehicle" /tmp/good.yaml
  sed --in-place 's/^lidars:/&\n  left: {source: "ouster:front.pcap?meta=front.json", T_base_sensor: {x: 0, y: 0, z: 1, roll: 0, pitch: 0, yaw: 0}}/' "$vehicle"
  must_tell "gvom-ingest@left.service is not enabled: systemctl enable --now gvom-ingest@left.service"
  cp /tmp/good.yaml "$vehicle"
}

check_no_broker() {
  stop_all
  install --mode 600 /dev/null /tmp/roudi.lock
  systemctl start gvom.target
  must_tell "gvom-roudi.service .* exit code 69: /tmp/roudi.lock belongs to user 0"
  rm /tmp/roudi.lock
  say "without a broker the status says why"
}

unpack_package
use_small_map
use_patience
use_recording
start_all
eventually 60 gvomctl status > /tmp/status.log 2>&1 || { cat /tmp/status.log; fail "not well at first"; }
check_hangup
set_key layers '{min_hits: 2}'
must_restart "layers.min_hits" gvom-fusion
gvomctl reload > /tmp/reload.log 2>&1 || fail "gvomctl reload without a change"
must_say "nobody who runs is concerned" /tmp/reload.log
check_broken_file
check_by_choice
check_not_enabled
set_key window '{buffer_size: 6}'
must_restart "window.buffer_size" "${members[@]}"
check_no_broker
say "well"
