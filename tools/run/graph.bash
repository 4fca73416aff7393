# shellcheck shell=bash disable=SC2154 # set by who sources this
# A graph's processes, for gvom-run and tools/demo: start, stop, and what to say when one ends that should not have.
# Of who sources it: fail, bin, logs, out, config, lidars.

declare -A pid_of=()  # the processes that this started and that have not been waited for
# In the order in which they are stopped: the broker last, for who still lives when it goes aborts.
order() { printf '%s\n' gvom-drive gvom-planner gvom-odometry "${lidars[@]/#/gvom-ingest-}" gvom-fusion gvom-snapshot gvom-bridge gvom-summary gvom-roudi; }

# In a session of its own, so that a Ctrl-C reaches this script alone, which then stops all in the right order; and it
# does not outlive a script that is killed. The log is emptied first: the last run's words are none of this one.
start() {  # start NAME COMMAND...
  local name=$1
  shift
  : > "$logs/$name.log"
  setsid setpriv --pdeathsig TERM "$@" > "$logs/$name.log" 2>&1 < /dev/null &
  pid_of[$name]=$!
}

stop() {  # stop NAME: returns its exit code
  local pid=${pid_of[$1]:-} code=0 i
  [[ -n $pid ]] || return 0
  kill -TERM "$pid" 2> /dev/null || true
  for ((i = 0; i < 200; ++i)); do
    kill -0 "$pid" 2> /dev/null || break
    sleep 0.05
  done
  if kill -KILL "$pid" 2> /dev/null; then echo "${0##*/}: $1 did not stop: killed" >&2; fi
  wait "$pid" || code=$?
  unset "pid_of[$1]"
  if ((code == 143)); then code=0; fi  # SIGTERM came before it had begun
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
  if [[ -n ${scratch:-} ]]; then rm -rf "$scratch"; fi
}
trap clean_up EXIT
trap 'echo; echo "${0##*/}: interrupted, stopping" >&2; exit 130' INT
trap 'exit 143' TERM
trap 'exit 129' HUP

give_up() {  # give_up NAME CODE: a process ended that should not have
  local code=$2
  clean_up
  echo "${0##*/}: $1 ended with exit code $code; the end of $logs/$1.log:" >&2
  tail -n 5 "$logs/$1.log" >&2
  ((code > 0)) || code=70
  exit "$code"
}

shared_memory_advice="In a container: start it with --shm-size=4g. Elsewhere: mount -o remount,size=4G /dev/shm"

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
    75) echo "${0##*/}: another broker runs on this machine; this leaves it alone. Stop it first: $(pgrep -a gvom-roudi)" >&2 ;;
    69) if grep -q /dev/shm "$logs/gvom-roudi.log"; then echo "${0##*/}: $shared_memory_advice" >&2; fi ;;
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
  setsid setpriv --pdeathsig TERM "$bin/gvom-summary" "${config[@]}" --json "$out/summary.json" --progress "${also[@]}" \
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
