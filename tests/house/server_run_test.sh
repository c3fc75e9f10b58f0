#!/usr/bin/env bash
# server/run as a newcomer starts it: from another folder, on a port of its own, until it is told
# to stop.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
server=
trap '[ -z "$server" ] || kill -KILL "$server" 2>/dev/null || true; rm -rf "$scratch"' EXIT
cd "$scratch"

fail() {
  echo "$1"
  sed 's/^/  | /' log
  exit 1
}

# get PATH: the status line and the body, over bash's own sockets.
get() {
  exec 3<>"/dev/tcp/127.0.0.1/$port"
  printf 'GET %s HTTP/1.1\r\nHost: 127.0.0.1:%s\r\nConnection: close\r\n\r\n' "$1" "$port" >&3
  cat <&3
  exec 3>&-
}

"$root/server/run" --listen 127.0.0.1:0 >log 2>&1 </dev/null &
server=$!
port=
for _ in $(seq 6000); do
  port=$(sed -n 's|.*listening on http://127\.0\.0\.1:\([0-9]*\).*|\1|p' log | head -n 1)
  [ -z "$port" ] || break
  kill -0 "$server" 2>/dev/null || fail "it ended before it listened"
  sleep 0.1
done
[ -n "$port" ] || fail "it did not say where it listens"

case $(get /healthz) in "HTTP/1.1 200 "*) ;; *) fail "it is not healthy" ;; esac
case $(get /api/maps/demo) in
  "HTTP/1.1 200 "*'"name":"demo"'*) ;;
  *) fail "it does not serve the map demo" ;;
esac
case $(get /) in
  "HTTP/1.1 200 "*"<canvas"*) ;;
  *) fail "it does not serve the page" ;;
esac

[ -s earthwork-data/demo.earthwork ] || fail "it keeps no map in the folder it was started in"

kill -TERM "$server"
stopped=$SECONDS
status=0
wait "$server" || status=$?
server=
[ $status -eq 0 ] || fail "it ended with status $status"
[ $((SECONDS - stopped)) -le 5 ] || fail "it took longer than 5 s to stop"
echo "served demo on port $port and stopped"
