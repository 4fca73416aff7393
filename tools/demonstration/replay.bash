# shellcheck shell=bash disable=SC2154 # set by tools/demo, which sources this
# For tools/demo: a recording, simulated or real, replayed through the graph.
# Of the demo: root, bin, logs, out, pictures, config, lidars, recording, seconds, rate, looped, simulated, vehicle_file.

# The same parameters, vehicle and simulator make the same bytes: then what is there is taken.
simulate() {
  recording=$out/recording
  local made_by
  made_by="--seconds $seconds $(sha256sum < "$vehicle_file") $(sha256sum < "$bin/gvom-sim")"
  if [[ $(cat "$recording/made-by" 2> /dev/null) == "$made_by" ]]; then
    echo "demo: the recording in $recording is the one wanted"
    return
  fi
  [[ ! -e $recording || -e $recording/made-by || -z $(ls -A "$recording") ]] ||
    fail 64 "$recording is not of a demo: another --out"
  echo "demo: simulating a drive of $seconds s"
  mkdir -p "$recording"
  echo "not finished" > "$recording/made-by"
  "$bin/gvom-sim" "${config[@]}" --out "$recording" --seconds "$seconds"
  echo "$made_by" > "$recording/made-by"
}

files() { find "$1/" -maxdepth 1 -name "$2" 2> /dev/null; }  # files FOLDER PATTERN: the folder's name is no pattern

holds() { [[ -n $(files "$1" "$2") ]]; }

source_of() {  # source_of LIDAR: the rules of the usage
  local folder pcaps jsons
  if [[ -f $recording/$1.pcap && -f $recording/$1.json ]]; then
    echo "ouster:$recording/$1.pcap?meta=$recording/$1.json"
    return
  fi
  local scans=("$recording/$1")
  if ((${#lidars[@]} == 1)); then scans+=("$recording/velodyne" "$recording"); fi
  for folder in "${scans[@]}"; do
    if holds "$folder" "*.bin" || holds "$folder" "*.pcd"; then
      echo "scans:$folder"
      return
    fi
  done
  mapfile -t pcaps < <(files "$recording" "*.pcap")
  mapfile -t jsons < <(files "$recording" "*.json")
  if ((${#lidars[@]} == 1 && ${#pcaps[@]} == 1 && ${#jsons[@]} == 1)); then
    echo "ouster:${pcaps[0]}?meta=${jsons[0]}"
    return
  fi
  fail 65 "$recording: nothing there that would be the data of lidar $1, see tools/demo --help"
}

find_data() {
  local lidar found
  [[ -f $recording/odometry.tum ]] || fail 65 "$recording: no odometry.tum in it"
  for lidar in "${lidars[@]}"; do
    found=$(source_of "$lidar")
    echo "demo: lidar $lidar: $found"
    config+=(--set "lidars.$lidar.source='$found'")
  done
  config+=(--set "odometry.source='tum:$recording/odometry.tum'")
}

start_graph() {
  start_readers
  # Drawing must not take time from the map.
  start gvom-snapshot nice -n 10 "$bin/gvom-snapshot" "${config[@]}" --out "$pictures" --every 2
  start_bridge
  start_summary gvom-snapshot
  start gvom-odometry "$bin/gvom-odometry" "${config[@]}" --rate "$rate" ${looped:+--loop}
}

replay() {
  awk -v rate="$rate" '!/^#/ && NF >= 8 { if (!n++) first = $1; last = $1 }
    END { printf "demo: replaying %.1f s of odometry at rate %s\n", last - first, rate }' "$recording/odometry.tum"
  if [[ -n $looped ]]; then echo "demo: again and again, until Ctrl-C"; fi
  start_graph
  # gvom-odometry is the clock: it ends when the recording is through and every map of it is fused.
  local code=0
  await_end gvom-odometry || code=$?
  if ((code != 0)); then give_up gvom-odometry "$code"; fi
  stop_graph
  keep_recorded
  if [[ $rate == max ]]; then
    echo "(--rate max keeps the queues full: these latencies say nothing about a vehicle's)"
  fi
}

compare_with_truth() {
  scratch=$(mktemp -d "$out/maps.XXXXXX")
  printf '\n=== against the truth\n'
  "$bin/gvom-map" "${config[@]}" --out "$scratch" 2> "$logs/gvom-map.log" || give_up gvom-map $?
  "$bin/gvom-truth" --truth "$recording" --map "$scratch" --json "$out/truth.json"
}

say_where_to_look() {
  local count
  count=$(find "$pictures" -name '[0-9]*-montage.png' | wc -l)
  cat <<END

=== what to look at
  $pictures/montage.png           all layers as they were at the end, north up
  $pictures/NNNNNN-montage.png    the same every 2 s, $count of them
  $pictures/{overview,height,flags,cost,...}.png  one layer each
  $out/demo.mcap                  the maps, for Foxglove
  $page           the page, while a demo runs: tools/demo --loop replays until Ctrl-C
  $out/summary.json${simulated:+, $out/truth.json}        the figures above
  $logs/                          what the processes said
END
  if [[ -n $simulated ]]; then
    cat <<END
The drive goes along +x: a step to the left at x = 12 m, a ditch across at x = 30 m (NEGATIVE as it comes near),
a person who crosses at x = 38 m, a branch overhead at x = 45 m, trees (HARD) and bushes (SOFT) on both sides.
END
  fi
}

demonstrate() {
  mkdir -p "$pictures"
  rm -f "$pictures"/[0-9][0-9][0-9][0-9][0-9][0-9]-montage.png
  local targets=(gvom-odometry gvom-snapshot)
  if [[ -n $simulated ]]; then targets+=(gvom-sim gvom-map gvom-truth); fi
  build "${targets[@]}"
  list_lidars
  start_broker
  if [[ -n $simulated ]]; then simulate; fi
  find_data
  replay
  if [[ -n $simulated ]]; then compare_with_truth; fi
  say_where_to_look
}
