# shellcheck shell=bash disable=SC2154 # set by tools/demo, which sources this
# For tools/demo --drive: a simulated vehicle finds its own way, in real time through the real processes.
# Of the demo: bin, logs, out, config, lidars, seed, length.

await_words() {  # await_words NAME WORDS: it says them, or has ended
  local i
  for ((i = 0; i < 1200; ++i)); do
    if grep -qs "$2" "$logs/$1.log"; then return; fi
    kill -0 "${pid_of[$1]}" 2> /dev/null || break
    sleep 0.05
  done
  local code=0
  stop "$1" || code=$?
  give_up "$1" "$code"
}

# It is the vehicle with its lidars: what it says of itself at the end is the truth.
start_vehicle() {
  local lidar port=7502
  for lidar in "${lidars[@]}"; do
    config+=(--set "lidars.$lidar.source='ouster-udp:$((port++))?meta=$out/$lidar.json'")
  done
  start gvom-drive "$bin/gvom-drive" "${config[@]}" --real-time --seeds "$seed" --length "$length" --strip all --out "$out"
  await_words gvom-drive 'stands at its start'
}

demonstrate() {
  build gvom-planner gvom-drive
  list_lidars
  start_broker
  echo "demo: world $seed, $length m: the simulated vehicle gets a course and nothing else"
  start_vehicle
  start_readers
  start gvom-planner "$bin/gvom-planner" "${config[@]}"
  start_summary gvom-drive
  local code=0
  await_end gvom-drive || code=$?
  stop_graph
  printf '\n=== the drive\n'
  grep -v '^[0-9][0-9]:' "$logs/gvom-drive.log"
  cat <<END

=== what to look at
  $out/campaign-$seed-$seed.png   the film: the map as the planner saw it, its way, the trajectory that it chose
  $out/campaign-$seed-$seed.csv   a line for each plan
  $out/summary.json, $logs/       figures of the processes, and what they said
END
  ((code == 0)) || fail "$code" "the vehicle did not arrive"
}
