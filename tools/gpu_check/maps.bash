# The comparisons of gpu-check: recordings and a simulated drive, mapped by both back ends.
# shellcheck shell=bash
# shellcheck disable=SC2154  # bin, graph_check, out, quick, recordings, run_private, tested, tests_by_s and vehicles are gpu-check's

map_by() {  # map_by WHAT BACKEND FOLDER ARGUMENT...: its words only where it fails
  local words=$out/$1-${3##*/}.txt
  by "$tests_by_s" "$bin/gvom-map" "${@:4}" --voxels --backend "$2" --out "$3" > "$words" 2>&1 ||
    { local code=$?; cat "$words"; return "$code"; }
}

map_twice() {  # map_twice NAME VEHICLE ARGUMENT...: the maps of both back ends go to maps/NAME
  local maps=$out/maps/$1
  rm -rf "$maps"
  map_by "$1" cpu "$maps/cpu" --config "${@:2}" || return
  map_by "$1" "$tested" "$maps/tested" --config "${@:2}" || return
  by "$tests_by_s" "$bin/gvom-compare" "$maps/cpu" "$maps/tested" || return
  if [[ $1 != simulated ]]; then rm -rf "$maps"; fi  # those that differ stay
}

map_in() {  # map_in FOLDER ...: map_twice, with sources relative to it
  cd "$1" || return
  map_twice "${@:2}"
}

recording() {  # recording NAME FOLDER VEHICLE ARGUMENT...
  if [[ -d $2 ]]; then
    begin step "map-$1" map_in "$2" "$1" "${@:3}"
  else
    skip "recording $1: no $2"
  fi
}

write_vehicles() {  # of the recordings that no vehicle file is for
  local at='roll: 0, pitch: 0, yaw:'
  cat > "$out/rellis.yaml" <<VEHICLE
name: rellis
lidars:
  os1: {T_base_sensor: {x: 0, y: 0, z: 1.4, $at 0}}
  vlp32: {T_base_sensor: {x: -0.252, y: 0.001, z: 1.308, $at 3.14159}}
VEHICLE
  cat > "$out/forest.yaml" <<VEHICLE
name: forest
vehicle: {base_height_m: 0.068}
lidars:
  top: {T_base_sensor: {x: 0.065, y: 0, z: 0.408, $at 2.35619}}
VEHICLE
}

map_recordings() {
  local data=$recordings still=(--odometry static) moving=(--odometry tum:odometry.tum) model
  local roof=$vehicles/kitti.yaml ouster=$vehicles/ouster_os1_128.yaml
  if [[ ! -d $data ]]; then
    skip "recordings: there is no $data (see --recordings)"
    return
  fi
  write_vehicles
  recording os1-128 "$data/ouster_os1_128_moving" "$ouster" --source 'top=ouster:os1_128.pcap?meta=os1_128.json' "${moving[@]}"
  if $quick; then return; fi
  recording kitti "$data/kitti_drive0005" "$roof" --source top=scans:. "${moving[@]}"
  recording os1-64 "$data/ouster_os1_64_legacy" "$ouster" --source 'top=ouster:os1_64.pcap?meta=os1_64.json' "${still[@]}"
  for model in os1_32_legacy os2_128_rng19; do
    recording "$model" "$data/ouster_variants" "$ouster" --source "top=ouster:$model.pcap?meta=$model.json" "${still[@]}"
  done
  for model in hdl32=HDL-32 vlp16_gps=VLP-16 'vlp16_outdoor=VLP-16&model_byte=0x21'; do
    recording "${model%%=*}" "$data/velodyne" "$roof" --source "top=velodyne:${model%%=*}.pcap?model=${model#*=}" "${still[@]}"
  done
  recording rellis "$data/rellis_offroad" "$out/rellis.yaml" --source os1=scans:os1_64.bin --source vlp32=scans:vlp32.bin "${still[@]}"
  recording forest "$data/forest" "$out/forest.yaml" --source top=scans:marv_ouster.pcd "${still[@]}"
}

replay() {  # in a /dev/shm of its own where that is allowed
  local sets=(--set "fusion.backend=$tested" --set "lidars.front.backend=$tested" --set "lidars.rear.backend=$tested")
  local check=("$graph_check" --bin "$bin" --maps "$out/maps/simulated/cpu" --out "$out/graph" --lidar front
    --lidar rear -- --config "$vehicles/two_lidars.yaml" "${sets[@]}")
  cd "$out/simulated" || return
  if "$run_private" true 2> /dev/null; then check=("$run_private" "${check[@]}"); fi
  by "$tests_by_s" "${check[@]}"
}

check_simulated() {  # one after the other
  local vehicle=$vehicles/two_lidars.yaml seconds=3
  if $quick; then seconds=1; fi
  step simulate by "$tests_by_s" "$bin/gvom-sim" --config "$vehicle" --out "$out/simulated" --seconds "$seconds"
  step map-simulated map_in "$out/simulated" simulated "$vehicle"
  step processes replay
  if "$bin/gvom-compare" "$out/maps/simulated/"{cpu,tested} > /dev/null 2>&1; then rm -rf "$out/maps/simulated"; fi
}
