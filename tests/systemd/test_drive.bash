#!/usr/bin/env bash
# A vehicle drives by the installed units: broker, ingest, fusion and planner; only the vehicle itself is simulated.
# shellcheck source=common.bash
source "$(dirname "$0")/common.bash"

members=(gvom-roudi gvom-fusion gvom-ingest@top gvom-planner)

# The Warthog of config/vehicles, its lidar on this machine's port.
use_driven_vehicle() {
  cp "$(dirname "$0")/../../config/vehicles/warthog.yaml" "$vehicle"
  sed --in-place 's|source: ouster-udp:.*|source: "ouster-udp:7502?meta=/var/lib/gvom/drive/top.json"|' "$vehicle"
  # In a world that stands still, a machine that pauses may drive by older maps.
  sed --in-place 's|^odometry:|&\n  max_clock_offset_s: 3|' "$vehicle"
  echo 'planner: {max_age_s: 2}' >> "$vehicle"
  install "$GVOM_BIN/gvom-drive" /usr/local/bin
  install --owner gvom --group gvom --directory /var/lib/gvom/drive
  systemctl daemon-reload
  systemctl --quiet enable gvom-ingest@top gvom-planner
}

says_that_it_stands() { grep --quiet 'stands at its start' /tmp/drive.log; }

unpack_package
use_patience
use_driven_vehicle
systemctl start gvom-roudi || fail "gvom-roudi"
# It becomes the broker's user by itself. Nobody walks in this world: whom it meets depends on when the processes are up.
set_off() {
  rm -f /tmp/drive.log
  gvom-drive --config "$vehicle" --real-time --seeds "${GVOM_SEED:-5}" --length 60 --out /var/lib/gvom/drive > /tmp/drive.txt 2> /tmp/drive.log &
  drive=$!
  eventually 120 says_that_it_stands || { cat /tmp/drive.log; fail "gvom-drive"; }
}

arrive() {
  local code=0
  wait "$drive" || code=$?
  cat /tmp/drive.txt
  for unit in "${members[@]}"; do
    [[ $(property "$unit" NRestarts) == 0 ]] || fail "$unit was restarted"
    say "$unit: $(property "$unit" StatusText)"
  done
  ((code == 0)) || { tail -n 5 /tmp/drive.log; fail "the vehicle did not arrive: $code"; }
  awk '/^campaign/ && $4 < 10 { exit 1 }' /tmp/drive.txt || fail "nobody drives 60 m in so short a time"
}

set_off
start_all
say "it drives"
arrive
# The planner has arrived already, and has the layers of where that was.
say "it drives again, by processes that run"
set_off
arrive
stop_all
say "well"
