# gvom-bridge.service in a running graph: its page, a peer of ROS 2, a kill, its recordings. Needs common.bash.
# shellcheck shell=bash

domain=7
page=/usr/share/gvom/page/index.html
recordings=/var/lib/gvom/recorded

use_bridge() {  # before anything starts: the file is everybody's
  ip link set lo multicast on
  ip route add 224.0.0.0/4 dev lo
  # shellcheck disable=SC2154  # vehicle: common.bash
  printf 'bridge:\n  mcap: {folder: %s}\n  ros2: {distro: jazzy, domain: %d, interface: lo}\n' "$recordings" "$domain" >> "$vehicle"
  if [[ ! -e $page ]]; then  # the package was built without npm
    mkdir -p "$(dirname "$page")"
    echo '<p>a page' > "$page"
  fi
}

page_comes() {
  exec 3<> /dev/tcp/127.0.0.1/8765 || return 1
  printf 'GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n' >&3
  cat <&3 > /tmp/page
  exec 3>&-
  head -n 1 /tmp/page | grep --quiet '^HTTP/1.1 200' && grep --quiet --fixed-strings "$(head -n 1 "$page")" /tmp/page
} 2> /dev/null

hears() {  # hears MODE TOPIC WORDS: whether a peer of Fast DDS gets a line that begins so
  local peer code=0
  mkfifo /tmp/peer.in
  exec 4<> /tmp/peer.in  # it stays until its input ends
  "$GVOM_BIN/dds_peer" "$domain" "$1" "$2" < /tmp/peer.in > /tmp/peer.log 4>&- &
  peer=$!
  eventually 60 grep --quiet "^$3" /tmp/peer.log || code=1
  kill "$peer"
  wait "$peer" || true
  exec 4>&-
  rm /tmp/peer.in
  return "$code"
}

check_network() {
  if [[ ! -x $GVOM_BIN/dds_peer ]]; then
    say "SKIPPED: no DDS peer (built without libfastrtps-dev or fastddsgen)"
    return
  fi
  hears hear-graph '' 'node / gvom ' || { cat /tmp/peer.log; fail "a peer does not see the bridge's node"; }
  hears hear-grid /gvom/costmap 'grid ' || { cat /tmp/peer.log; fail "a peer gets no costmap"; }
  say "a peer of Fast DDS sees its node and gets costmaps"
}

is_new_bridge() {  # is_new_bridge OLD_PID
  local pid
  pid=$(pid_of gvom-bridge)
  ((pid != 0 && pid != $1)) && are_active gvom-bridge
}

have_recorded() {  # have_recorded FILES: so many have something in them
  [[ $(find "$recordings" -name 'gvom-*.mcap' -size +100k 2> /dev/null | wc -l) == "$1" ]]
}

check_recordings() {  # of a bridge that was killed, and of one that was stopped
  local file count=0
  for file in "$recordings"/gvom-*.mcap; do
    gvomctl bag "$file" > /tmp/bag.log 2>&1 || { cat /tmp/bag.log; fail "$file cannot be read"; }
    grep --quiet --fixed-strings /gvom/costmap /tmp/bag.log || { cat /tmp/bag.log; fail "$file: no costmap"; }
    count=$((count + 1))
  done
  ((count == 2)) || fail "$count recordings, not one of each bridge"
}

check_bridge() {
  local pid
  say "starting gvom-bridge"
  systemctl start gvom-bridge || fail "gvom-bridge does not start"
  eventually 60 page_comes || { head -c 300 /tmp/page; fail "the bridge serves no page"; }
  check_network
  eventually 60 have_recorded 1 || fail "nothing is recorded in $recordings"
  pid=$(pid_of gvom-bridge)
  kill -KILL "$pid"
  eventually 60 is_new_bridge "$pid" || fail "gvom-bridge is not back after kill -9"
  eventually 60 page_comes || fail "no page after kill -9"
  eventually 60 have_recorded 2 || fail "the new bridge does not record"
  systemctl stop gvom-bridge
  [[ $(property gvom-bridge Result) == success ]] || fail "gvom-bridge ended with $(property gvom-bridge Result)"
  check_recordings
  [[ $(property gvom-fusion NRestarts) == 0 ]] || fail "the bridge's death takes fusion with it"
  say "the bridge serves its page, joins ROS 2, is back after kill -9, and its recordings are whole"
}
