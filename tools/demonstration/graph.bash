# shellcheck shell=bash disable=SC2154 # set by tools/demo, which sources this
# The graph's processes, for tools/demo: build, start, stop, and what to say when one ends that should not have.
# Of the demo: root, bin, logs, out, config, lidars, looped, simulated.

declare -A pid_of=()  # the processes that this started and that have not been waited for
scratch=''            # a folder that goes when the demo ends
page=http://127.0.0.1:8765
# In the order in which they are stopped: the broker last, for who still lives when it goes aborts.
order() { printf '%s\n' gvom-drive gvom-planner gvom-odometry "${lidars[@]/#/gvom-ingest-}" gvom-fusion gvom-snapshot gvom-bridge gvom-summary gvom-roudi; }

# In a session of its own, so that a Ctrl-C reaches this script alone, which then stops all in the right order.
start() {  # start NAME COMMAND...
  local name=$1
  shift
  setsid "$@" > "$logs/$name.log" 2>&1 < /dev/null &
  pid_of[$name]=$!
}

stop() {  # stop NAME: returns its exit code
  local pid=${pid_of[$1]:-} code=0 i
  [[ -n $pid ]] || return 0
  unset "pid_of[$1]"
  kill -TERM "$pid" 2> /dev/null || true
  for ((i = 0; i < 200; ++i)); do
    kill -0 "$pid" 2> /dev/null || break
    sleep 0.05
  done
  if kill -KILL "$pid" 2> /dev/null; then echo "demo: $1 did not stop: killed" >&2; fi
  wait "$pid" || code=$?
  return "$code"
}

name_of() {  # name_of PID
  local name
  for name in "${!pid_of[@]}"; do
    if [[ ${pid_of[$name]} == "$1" ]]; then echo "$name"; fi
  done
}

clean_up() {
  trap '' INT TERM HUP
  local name
  for name in $(order); do stop "$name" > /dev/null || true; done
  if [[ -n $scratch ]]; then rm -rf "$scratch"; fi
}
trap clean_up EXIT
trap 'echo; echo "demo: interrupted, stopping" >&2; exit 130' INT
trap 'exit 143' TERM
trap 'exit 129' HUP

give_up() {  # give_up NAME CODE: a process ended that should not have
  local code=$2
  clean_up
  echo "demo: $1 ended with exit code $code; the end of $logs/$1.log:" >&2
  tail -n 5 "$logs/$1.log" >&2
  ((code > 0)) || code=70
  exit "$code"
}

shared_memory_advice="In a container: start it with --shm-size=2g. Elsewhere: mount -o remount,size=2G /dev/shm"

# The broker itself knows exactly what it needs and says so; this is to say it before building for minutes.
check_shared_memory() {
  local megabytes
  megabytes=$(df --output=size --block-size=1M /dev/shm 2> /dev/null | tail -n 1) || megabytes=0
  ((megabytes >= 1400)) || fail 69 "/dev/shm has room for $((megabytes)) MB; the broker's shared memory needs about\
 1.6 GB. $shared_memory_advice"
}

build() {  # build TARGET...
  if command -v ccache > /dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi
  echo "demo: building (the first time takes some minutes)"
  cmake --preset release -DGVOM_TESTS=OFF > "$logs/configure.log" || fail 70 "cmake failed, see $logs/configure.log"
  cmake --build --preset release --parallel "$(nproc)" --target gvom-roudi gvom-ingest gvom-fusion gvom-bridge gvom-summary "$@"
  services/bridge/page/build.sh build/share/gvom/page || echo "demo: so $page will have nothing to show" >&2
}

# Maps, plans and Health for a browser and Foxglove, and as a file. What others may see of it takes no time from the map.
start_bridge() {
  local recorded="$out/mcap"
  rm -rf "$recorded"
  if [[ -n $looped ]]; then recorded=''; fi
  start gvom-bridge nice -n 10 "$bin/gvom-bridge" "${config[@]}" --set "bridge.mcap.folder='$recorded'"
  echo "demo: to watch it: $page (Foxglove: ws://127.0.0.1:8765)"
}

keep_recorded() {  # the bridge's file, under a name that is easily found
  local files
  mapfile -t files < <(compgen -G "$out/mcap/*.mcap")
  ((${#files[@]} == 1)) || fail 70 "$out/mcap: one file was expected, there are ${#files[@]}"
  mv "${files[0]}" "$out/demo.mcap"
  rmdir "$out/mcap"
}

list_lidars() {
  local printed
  printed=$("$bin/gvom-roudi" "${config[@]}" --print-config) || exit $?
  mapfile -t lidars < <(sed -n "/^lidars:/,\$ s/^  '\(.*\)':\$/\1/p" <<< "$printed")
}

await_words() {  # await_words NAME WORDS: until it says them; returns the exit code of one that ended first
  local i
  for ((i = 0; i < 1200; ++i)); do
    if grep -qs "$2" "$logs/$1.log"; then return 0; fi
    kill -0 "${pid_of[$1]}" 2> /dev/null || break
    sleep 0.05
  done
  local code=0
  stop "$1" || code=$?
  return "$((code > 0 ? code : 70))"
}

start_broker() {
  local code=0
  start gvom-roudi "$bin/gvom-roudi" "${config[@]}"
  await_words gvom-roudi 'is up after' || code=$?
  case $code in
    0) return ;;
    75) echo "demo: another broker runs on this machine; this leaves it alone. Stop it first." >&2 ;;
    69) echo "demo: $shared_memory_advice" >&2 ;;
  esac
  give_up gvom-roudi "$code"
}

start_readers() {
  local lidar
  start gvom-fusion "$bin/gvom-fusion" "${config[@]}"
  for lidar in "${lidars[@]}"; do
    start "gvom-ingest-$lidar" "$bin/gvom-ingest" "${config[@]}" --lidar "$lidar"
  done
}

start_summary() {  # start_summary [NAME...]: these publish no Health
  local name also=()
  for name in gvom-roudi "$@"; do also+=(--also "$name=${pid_of[$name]}"); done
  setsid "$bin/gvom-summary" "${config[@]}" --json "$out/summary.json" --progress "${also[@]}" \
    2> "$logs/gvom-summary.log" < /dev/null &
  pid_of[gvom-summary]=$!
}

await_end() {  # await_end NAME: the one that ends by itself, before any other; returns its exit code
  local ended='' code=0 name
  wait -n -p ended "${pid_of[@]}" || code=$?
  name=$(name_of "$ended")
  unset "pid_of[$name]"
  [[ $name == "$1" ]] || give_up "$name" "$code"
  return "$code"
}

stop_graph() {
  local name code
  for name in $(order); do
    code=0
    stop "$name" || code=$?
    if ((code != 0)); then give_up "$name" "$code"; fi
  done
}
