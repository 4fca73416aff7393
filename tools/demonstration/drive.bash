# shellcheck shell=bash disable=SC2154 # set by tools/demo, which sources this
# For tools/demo --drive: a simulated vehicle finds its own way, in real time through the real processes.
# Of the demo: bin, logs, out, config, lidars, seed, length.

# It is the vehicle with its lidars: what it says of itself at the end is the truth.
start_vehicle() {
  local lidar port=7502
  for lidar in "${lidars[@]}"; do
    config+=(--set "lidars.$lidar.source='ouster-udp:$((port++))?meta=$out/$lidar.json'")
  done
  start gvom-drive "$bin/gvom-drive" "${config[@]}" --real-time --seeds "$seed" --length "$length" --strip all --out "$out"
  local code=0
  await_words gvom-drive 'stands at its start' || code=$?
  ((code == 0)) || give_up gvom-drive "$code"
}

demonstrate() {
  build gvom-planner gvom-drive
  list_lidars
  start_broker
  echo "demo: world $seed, $length m: the simulated vehicle gets a course and nothing else"
  start_vehicle
  start_readers
  start gvom-planner "$bin/gvom-planner" "${config[@]}"
  start_bridge
  start_summary gvom-drive
  local code=0
  await_end gvom-drive || code=$?
  stop_graph
  printf '\n=== the drive\n'
  grep -v '^[0-9][0-9]:' "$logs/gvom-drive.log" || echo "it said nothing: $logs/gvom-drive.log"
  keep_recorded
  cat <<END

=== what to look at
  $out/campaign-$seed-$seed.png   the film: the map as the planner saw it, its way, the trajectory that it chose
  $out/campaign-$seed-$seed.csv   a line for each plan
  $out/demo.mcap                  maps, path and trajectory, for Foxglove
  $out/summary.json, $logs/       figures of the processes, and what they said
END
  ((code == 0)) || fail "$code" "the vehicle did not arrive"
}
