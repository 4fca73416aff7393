# shellcheck shell=bash disable=SC2154 # set by tools/demo, which sources this
# What both kinds of demo do beside the graph: build, and show it.
# Of the demo: bin, config, logs, looped, out.

page=http://127.0.0.1:8765
# The broker itself knows exactly what it needs and says so; this is to say it before building for minutes.
check_shared_memory() {
  local megabytes
  megabytes=$(df --output=size --block-size=1M /dev/shm 2> /dev/null | tail -n 1) || megabytes=0
  ((megabytes >= 1400)) || fail 69 "/dev/shm has room for $((megabytes)) MB; the broker's shared memory needs about\
 1.6 GB. $shared_memory_advice"
}

build() {  # build TARGET...
  if command -v ccache > /dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi
  echo "${0##*/}: building (the first time takes some minutes)"
  cmake --preset release -DGVOM_TESTS=OFF > "$logs/configure.log" || fail 70 "cmake failed, see $logs/configure.log"
  cmake --build --preset release --parallel "$(nproc)" --target gvom-roudi gvom-ingest gvom-fusion gvom-bridge gvom-summary "$@"
  services/bridge/page/build.sh build/share/gvom/page || echo "${0##*/}: so $page will have nothing to show" >&2
}

# Maps, plans and Health for a browser and Foxglove, and as a file. What others may see of it takes no time from the map.
start_bridge() {
  recorded=''
  if [[ -z $looped ]]; then recorded=$(mktemp -d "$out/mcap.XXXXXX"); fi
  start gvom-bridge nice -n 10 "$bin/gvom-bridge" "${config[@]}" --set "bridge.mcap.folder='$recorded'" --set bridge.mcap.split_mb=1048576 --set bridge.mcap.min_free_mb=0
  echo "demo: to watch it: $page (Foxglove: ws://127.0.0.1:8765)"
}

keep_recorded() {  # the bridge's file, under a name that is easily found
  local files
  mapfile -t files < <(find "$recorded" -name '*.mcap')
  ((${#files[@]} == 1)) || fail 70 "$recorded: one file was expected, there are ${#files[@]}"
  mv "${files[0]}" "$out/demo.mcap"
  rmdir "$recorded"
}
