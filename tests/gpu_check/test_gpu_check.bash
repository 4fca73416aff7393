#!/usr/bin/env bash
# test_gpu_check.bash SOURCE BIN: gpu-check in a bundle whose GPU is the fake device, with two planted faults: its
# verdict tells them so that nobody has to look again. And without a driver, and killed.
set -euo pipefail
source=$1
export GVOM_REAL_BIN=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export GVOM_HOLDER_FILE=$scratch/holder
export GVOM_SLOWER=3  # a busy machine may be
bundle=$scratch/bundle
gpu_check=$bundle/bin/gpu-check

fail() {
  echo "FAILED: $1" >&2
  if [[ -e $scratch/said ]]; then cat "$scratch/said" >&2; fi
  exit 1
}

expect() {  # expect WORDS: the verdict has them
  [[ $verdict == *"$1"* ]] || fail "the verdict does not say: $1"
}

make_bundle() {
  local program tests=$bundle/libexec/gvom/tests
  mkdir -p "$bundle/bin" "$tests" "$bundle/share/gvom"
  cp "$source/tools/gpu-check" "$bundle/bin/"
  for program in gvom-{bench,fusion,ingest,map,odometry,roudi}; do ln -s "$source/tests/gpu_check/as-cuda" "$bundle/bin/$program"; done
  for program in gvom-{compare,sim,snapshot}; do ln -s "$GVOM_REAL_BIN/$program" "$bundle/bin/"; done
  ln -s "$source/config/vehicles" "$bundle/share/gvom/"
  ln -s "$source/tests/run-private.sh" "$source/tools/graph-check" "$source/tools/gpu_check" "$tests/"
  ln -s "$source/tests/gpu_check/fails-here" "$tests/test_cuda_twins"
  ln -s /bin/true "$tests/test_cuda_sticky"
}

holder_ends() {
  local i pid
  pid=$(< "$GVOM_HOLDER_FILE")
  for ((i = 0; i < 400; ++i)); do
    kill -0 "$pid" 2> /dev/null || return 0
    sleep 0.05
  done
  kill -KILL "$pid"
  return 1
}

tell_faults() {
  local code=0 verdict
  (cd "$scratch" && "$gpu_check" --quick --recordings "$scratch" --out "$scratch/out") > "$scratch/said" 2>&1 || code=$?
  ((code == 1)) || fail "gpu-check ended with $code instead of 1"
  verdict=$(< "$scratch/out/verdict.txt")
  [[ $(< "$scratch/said") == *"$verdict" ]] || fail "the verdict is not what it says last"
  ((${#verdict} < 12000)) || fail "the verdict has ${#verdict} characters"
  expect '=== gpu-check: fake device on the host'
  expect 'FAIL      map-simulated: exit code 1'
  expect $'000003/height.npy: 1 of 65536 differ\n  [0, 0]: expected '
  expect ', found 1.00000012 = 0x3f800001'
  expect 'FAIL      test_cuda_twins-2: exit code 42'
  expect 'the first words'
  expect 'the last words'
  for step in test_cuda_twins-1 simulate processes test_cuda_sticky bench-os1-128; do expect "$step "; done
  expect 'SKIP      recording os1-128: no '
  expect $'\n64 x 64 x 32 '
  [[ ${verdict##*$'\n'} == 'verdict: FAILED ('*' passed, 2 failed)' ]] || fail "its last line is ${verdict##*$'\n'}"
  holder_ends || fail "the device is still held after gpu-check has ended"
}

end_with_it() {  # while a step runs that goes on for longer than the holder may
  local pid i
  rm -f "$GVOM_HOLDER_FILE"
  GVOM_SLOW_S=40 "$gpu_check" --quick --out "$scratch/killed" > "$scratch/said" 2>&1 &
  pid=$!
  for ((i = 0; i < 1200; ++i)); do
    if [[ -s $GVOM_HOLDER_FILE && -e $scratch/killed/test_cuda_twins-1.log ]]; then break; fi
    sleep 0.05
  done
  kill -KILL "$pid"
  wait "$pid" 2> /dev/null || true
  holder_ends || fail "the device is still held after gpu-check was killed"
}

say_no_driver() {
  local code=0 said
  if compgen -G '/dev/nvidia*' > /dev/null; then return; fi
  ln -sf "$GVOM_REAL_BIN/gvom-bench" "$bundle/bin/gvom-bench"
  said=$("$gpu_check" --out "$scratch/none" 2>&1) || code=$?
  ((code == 69)) || fail "without a driver gpu-check ended with $code instead of 69: $said"
  [[ $said == 'gpu-check: no NVIDIA driver' || $said == 'gpu-check: this build has no CUDA' ]] ||
    fail "without a driver gpu-check said: $said"
}

make_bundle
tell_faults
end_with_it
say_no_driver
echo "gpu-check tells what it finds"
