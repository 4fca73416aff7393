# Steps of gpu-check: each with a log and a result, many at a time.
# shellcheck shell=bash
# shellcheck disable=SC2154  # out, places and hold_in are gpu-check's

running=()  # process groups

prepare_steps() {
  rm -rf "$out/steps"
  mkdir -p "$out/steps"
  : > "$out/skipped.txt"
}

skip() {  # skip WORDS: for the verdict
  echo "$1" >> "$out/skipped.txt"
}

step() {  # step NAME COMMAND...: its output goes to NAME.log, how it ended to steps/; 77 is a skip
  local name=$1 begin_us=${EPOCHREALTIME/[^0-9]/} code=0 line us word=FAIL
  local result=$out/steps/$begin_us-$name
  shift
  kill -0 $$ 2> /dev/null || return  # gpu-check was killed
  echo "did not end" > "$result"
  "$@" > "$out/$name.log" 2>&1 < /dev/null || code=$?
  us=$((${EPOCHREALTIME/[^0-9]/} - begin_us))
  printf '%d %d.%d\n' "$code" $((us / 1000000)) $((us % 1000000 / 100000)) > "$result"
  while IFS= read -r line; do
    if [[ $line == *SKIPPED:* ]]; then skip "$name: ${line#*SKIPPED: }"; fi
  done < "$out/$name.log"
  case $code in
    0) word=pass ;;
    77) word=skip ;;
  esac
  printf '%4d s  %s  %s\n' "$SECONDS" "$word" "$name"
}

by() {  # by SECOND COMMAND...: it must have ended when gpu-check has run that long
  local left=$(($1 - SECONDS))
  shift
  ((left > 0)) || { echo "no time is left for it"; return 124; }
  timeout --foreground --kill-after=5 "$left" "$@"
}

await_fewer_than() {  # await_fewer_than COUNT: steps that run
  local group left
  while true; do
    left=()
    for group in "${running[@]}"; do
      if kill -0 "$group" 2> /dev/null; then left+=("$group"); fi
    done
    running=("${left[@]}")
    if ((${#running[@]} < $1)); then return; fi
    sleep 0.05
  done
}

begin() {  # begin COMMAND...: in the background, in a process group of its own, as soon as there is a place
  await_fewer_than "$places"
  set -m
  if [[ -n ${hold_in:-} ]]; then "$@" {hold_in}>&- & else "$@" & fi
  running+=($!)
  set +m
}

await() { await_fewer_than 1; }

end_steps() {  # of a run that breaks off
  local group
  for group in "${running[@]}"; do kill -TERM -- "-$group" 2> /dev/null || true; done
}
