# shellcheck shell=bash disable=SC2154,SC2034 # set by tools/bench, which sources this, for tools/demonstration/*.bash
# For tools/bench: the whole graph, the sinks of the bridge with who reads them, and how long that takes.
# Of the bench: root, bin, logs, out, phases, seconds, buffer.

domain=77
port=8765
eleven_layers=height,inferred_height,slope_x,slope_y,slope,roughness,obstacle_density,negative_delta,clearance,last_seen,cost
ros2_topics=(
  /gvom/costmap=nav_msgs/msg/OccupancyGrid /gvom/grid_map=grid_map_msgs/msg/GridMap /gvom/points=sensor_msgs/msg/PointCloud2
  /gvom/voxels=sensor_msgs/msg/PointCloud2 /tf=tf2_msgs/msg/TFMessage /diagnostics=diagnostic_msgs/msg/DiagnosticArray)
looped='' simulated='' lidars=()

order() {
  printf '%s\n' gvom-summary robot foxglove-reader ros2-reader gvom-bridge gvom-odometry "${lidars[@]/#/gvom-ingest-}" gvom-fusion gvom-roudi
}

use_all_sinks() {
  local names=("${ros2_topics[@]%%=*}") all
  all=$(IFS=,; echo "${names[*]}")
  config+=(--set bridge.ros2.distro=jazzy --set bridge.ros2.interface=lo --set "bridge.ros2.domain=$domain"
    --set "bridge.ros2.topics='$all'" --set "bridge.grid_map_layers='$eleven_layers'"
    --set "bridge.foxglove.port=$port" --set "bridge.mcap.folder='$out/mcap'"
    --set "bridge.mcap.topics='$all,/gvom/layers,/gvom/status'")
}

# As a unit has it: nice 10. Who reads has the priority that any other program has.
start_sinks() {
  rm -rf "$out/mcap"
  start gvom-bridge nice -n 10 "$bin/gvom-bridge" "${config[@]}"
  await_words gvom-bridge 'foxglove: at' || give_up gvom-bridge $?
  start ros2-reader "$bin/dds_robot" "$domain" look "${ros2_topics[@]}"
  start foxglove-reader "$bin/foxglove_reader" "$port"
  await_words ros2-reader 'got /gvom/grid_map' || give_up ros2-reader $?
}

stop_sinks() {  # stop_sinks NAME: what came goes to NAME.txt
  local reader
  for reader in ros2-reader foxglove-reader; do
    stop "$reader" || give_up "$reader" $?
    sed -n "s|^\(/.* received .*\)|$reader \1|p" "$logs/$reader.log"
  done > "$out/$1.txt"
  stop gvom-bridge || give_up gvom-bridge $?
  rm -rf "$out/mcap"
}

listen() {  # listen NAME PROCESS...: for so many seconds; what gvom-summary says goes to NAME.json
  local name=$1 also=() process
  shift
  for process in gvom-roudi "$@"; do also+=(--also "$process=${pid_of[$process]}"); done
  start gvom-summary "$bin/gvom-summary" "${config[@]}" --json "$out/$name.json" "${also[@]}"
  sleep "$seconds"
  stop gvom-summary || give_up gvom-summary $?
}

measure_bridge() {
  vehicle_file=$root/config/vehicles/two_lidars.yaml
  config=(--config "$vehicle_file")
  list_lidars
  simulate
  find_data
  use_all_sinks
  start_broker
  start_readers
  start gvom-odometry "$bin/gvom-odometry" "${config[@]}" --rate 1 --loop
  local phase
  for ((phase = 1; phase <= phases; ++phase)); do
    sleep 2
    listen "without-$phase"
    start_sinks
    sleep 2
    listen "with-$phase" ros2-reader foxglove-reader
    stop_sinks "with-$phase"
    echo "bench: $phase of $phases"
  done
  stop_graph
  node tools/benchmark/load-report.mjs bridge "$out"
}

write_cloud_vehicle() {
  local network="interface=lo&domain=$domain" limit=$out/cyclone.xml
  if [[ -n $buffer ]]; then
    echo "<CycloneDDS><Domain><Internal><SocketReceiveBufferSize max=\"${buffer}B\"/></Internal></Domain></CycloneDDS>" > "$limit"
  fi
  cat <<VEHICLE
name: cloud
ipc:
  max_planners: 2
odometry:
  source: ros2:/odom?$network
lidars:
  top:
    source: ros2:/points?$network${buffer:+&config=$limit}
    T_base_sensor: {x: 0, y: 0, z: 1.7, roll: 0, pitch: 0, yaw: 0}
VEHICLE
}

measure_cloud() {
  write_cloud_vehicle > "$out/vehicle.yaml"
  config=(--config "$out/vehicle.yaml")
  list_lidars
  use_all_sinks
  start_broker
  start_readers
  start gvom-odometry "$bin/gvom-odometry" "${config[@]}"
  await_words gvom-ingest-top 'top from' || give_up gvom-ingest-top $?
  start gvom-summary "$bin/gvom-summary" "${config[@]}" --json "$out/cloud.json" --also "gvom-roudi=${pid_of[gvom-roudi]}"
  start robot "$bin/dds_robot" "$domain" drive 120000 20
  start_sinks
  sleep "$seconds"
  stop robot || give_up robot $?
  sleep 2  # the last Health
  stop_sinks cloud
  stop gvom-summary || give_up gvom-summary $?
  sed -n 's|^\(/.* sent .*\)|robot \1|p' "$logs/robot.log" >> "$out/cloud.txt"
  stop_graph
  node tools/benchmark/load-report.mjs cloud "$out"
}
