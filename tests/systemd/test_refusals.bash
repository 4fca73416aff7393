#!/usr/bin/env bash
# What a restart can't cure is not restarted; what may come later is tried slowly: memory, a GPU, files of others.
# shellcheck source=common.bash
source "$(dirname "$0")/common.bash"

has_failed_with() {  # has_failed_with UNIT CODE
  [[ $(systemctl is-failed "$1" || true) == failed && $(property "$1" ExecMainStatus) == "$2" ]]
}

must_refuse() {  # must_refuse UNIT CODE WORDS: it fails so, and stays so
  eventually 60 has_failed_with "$1" "$2" || fail "$1 did not fail with $2"
  sleep 1
  has_failed_with "$1" "$2" || fail "$1 was started again"
  [[ $(property "$1" NRestarts) == 0 ]] || fail "$1 was restarted $(property "$1" NRestarts) times"
  eventually 60 has_said "$1" "$3" || fail "$1 did not say: $3"
  say "$1 ends with $2 and stays so"
}

give_arguments() {  # give_arguments UNIT ARGUMENTS
  mkdir -p "/etc/systemd/system/$1.d"
  printf '%s\n' '[Service]' "Environment=\"ARGUMENTS=$2\"" > "/etc/systemd/system/$1.d/test.conf"
  systemctl daemon-reload
}

has_restarted() { (($(property gvom-fusion NRestarts) >= 1)); }

check_missing_gpu() {
  local start before more took_ms
  give_arguments gvom-fusion.service "--set fusion.backend=cuda"
  systemctl restart --no-block gvom-fusion
  eventually 60 has_restarted || fail "gvom-fusion without its GPU is not started again"
  start=$(now_ms) before=$(property gvom-fusion NRestarts)
  sleep 3
  more=$(($(property gvom-fusion NRestarts) - before)) took_ms=$(($(now_ms) - start))
  say "fusion without its GPU: $more more starts in $took_ms ms"
  ((more <= 1 + took_ms / 1000)) || fail "that is too often"
  are_active gvom-ingest@front gvom-roudi || fail "others suffer from it"
  rm -r /etc/systemd/system/gvom-fusion.service.d
  systemctl daemon-reload
  eventually 60 are_active gvom-fusion || fail "fusion did not come back once it could"
}

# What others left in the way, or fill: tried again each second, and well once it is gone.
check_full_memory() {
  say "/dev/shm is full at the start"
  mount -o remount,size=512m /dev/shm
  fallocate --length 500M /dev/shm/others
  systemctl start gvom.target
  eventually 60 has_said gvom-roudi.service "bytes in /dev/shm" || fail "gvom-roudi did not say that /dev/shm is full"
  if are_active gvom-fusion; then fail "gvom-fusion runs without a broker"; fi
  rm /dev/shm/others
  eventually 60 are_active "${members[@]}" || fail "not all came up once there was room"
}

check_foreign_files() {
  local file
  for file in /tmp/gvom-fusion.lock /tmp/gvom-fusion; do  # a lock, a socket
    systemctl stop gvom-fusion
    rm -f "$file"
    install --mode 600 /dev/null "$file"
    systemctl start --no-block gvom-fusion
    eventually 60 has_said gvom-fusion.service "$file belongs to user 0" || fail "gvom-fusion did not name $file"
    rm "$file"
    eventually 60 are_active gvom-fusion || fail "gvom-fusion did not come up without $file"
  done
  say "another user's lock and socket are named, and waited for"
}

# All at once, as when the power goes: no process tidies up, and what they held stays locked in memory.
check_leftovers() {
  local folder=/run/systemd/system/gvom-.service.d
  mkdir -p "$folder"
  printf '%s\n' '[Service]' Restart=no > "$folder/no-restart.conf"  # a new broker would tidy up
  systemctl daemon-reload
  systemctl kill --signal KILL 'gvom-*'
  systemctl stop gvom.target 'gvom-*'
  [[ -e /tmp/roudi.lock && -e /dev/shm/iceoryx_mgmt ]] || fail "a kill of all leaves nothing behind?"
  rm -r "$folder"
  systemctl daemon-reload
  start_all
  must_see_layers "after what a kill of all left behind"
}

unpack_package
use_small_map
use_patience
use_recording
check_full_memory
check_foreign_files
check_leftovers
systemctl start gvom-ingest@left || true
must_refuse gvom-ingest@left 78 "left"
check_missing_gpu
printf 'not a recording' > /var/lib/gvom/rear.pcap
systemctl restart gvom-ingest@rear || true
must_refuse gvom-ingest@rear 65 "rear.pcap"
are_active gvom-roudi gvom-fusion gvom-ingest@front || fail "others suffer from it"
stop_all
echo "window: {bufer_size: 3}" >> "$vehicle"
systemctl start gvom.target || true
must_refuse gvom-roudi 78 "$vehicle"
say "well"
