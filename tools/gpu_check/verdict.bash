# The last screen of gpu-check: what passed, the figures, and of what failed enough to find out why.
# shellcheck shell=bash
# shellcheck disable=SC2154  # out, tested and device are gpu-check's

most_characters=11500
told_failures=4  # at length; of the others the names

passed=() failed=() unwell=()

sort_results() {
  local file name code seconds
  for file in "$out"/steps/*; do
    [[ -e $file ]] || continue
    name=${file##*/} name=${name#*-}
    read -r code seconds < "$file"
    case $code in
      0) passed+=("$name $seconds s") ;;
      77) ;;  # its log has said why
      124) failed+=("$name: ran out of time after $seconds s") unwell+=("$name") ;;
      did) failed+=("$name: was broken off") unwell+=("$name") ;;
      *) failed+=("$name: exit code $code after $seconds s") unwell+=("$name") ;;
    esac
  done
}

wrapped() {  # wrapped TITLE ENTRY...: entries in lines of at most 110 characters
  local line=$1 entry
  shift
  for entry in "$@"; do
    if ((${#line} + ${#entry} > 107)); then
      echo "$line"
      line="        "
    fi
    line+="  $entry;"
  done
  echo "${line%;}"
}

excerpt() {  # excerpt FILE CHARACTERS: all of it, or its beginning and its end
  local text
  text=$(< "$1")
  if ((${#text} > $2)); then text=${text:0:$(($2 * 2 / 3))}$'\n[...]\n'${text: -$(($2 / 3))}; fi
  printf '%s\n' "$text"
}

say_overview() {
  local line lines
  printf '=== gpu-check: %s\n' "$device"
  printf '%d processors, %d min %d s; logs in %s\n' "$(nproc)" $((SECONDS / 60)) $((SECONDS % 60)) "$out"
  wrapped "pass    " "${passed[@]}"
  mapfile -t -n 12 lines < "$out/skipped.txt"
  for line in "${lines[@]}"; do printf 'SKIP      %s\n' "${line:0:150}"; done
  for line in "${failed[@]:0:40}"; do echo "FAIL      $line"; done
  for line in "$out"/bench-*.txt; do
    if [[ -e $line ]]; then printf '\n%s\n' "$(< "$line")"; fi
  done
}

say_failures() {  # say_failures CHARACTERS
  local name count=$((${#unwell[@]} < told_failures ? ${#unwell[@]} : told_failures))
  for name in "${unwell[@]:0:count}"; do
    printf '\n--- FAIL %s\n' "$name"
    excerpt "$out/$name.log" $(($1 / count))
  done
}

say_result() {
  local words="$((${#passed[@]})) passed, ${#failed[@]} failed"
  if [[ $tested == cpu ]]; then words+="; NO GPU WAS TESTED: the CPU was compared with itself"; fi
  printf '\nverdict: %s (%s)\n' "$1" "$words"
}

verdict() {  # prints it and leaves it in verdict.txt; false if anything failed
  local overview result=PASSED
  sort_results
  ((${#failed[@]} == 0 && ${#passed[@]} > 0)) || result=FAILED
  overview=$(say_overview)
  {
    printf '\n%s\n' "$overview"
    say_failures $((most_characters - ${#overview} - 600))
    say_result "$result"
  } > "$out/verdict.txt"
  cat "$out/verdict.txt"
  [[ $result == PASSED ]]
}
