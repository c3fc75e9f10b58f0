#!/usr/bin/env bash
# Runs inside a container of the image, as its user: inside.sh ARGUMENTS OF EARTHWORK-SERVER...
set -euo pipefail

script=$(dirname "${BASH_SOURCE[0]}")/../conformance/50_random_R8_200.jsonl
log=$(mktemp)
server=
trap '[ -z "$server" ] || kill -KILL "$server" 2>/dev/null || true; rm -f "$log"' EXIT

fail() {
  echo "$1" >&2
  sed 's/^/  | /' "$log" >&2
  exit 1
}

[ "$(id -u)" -eq 900 ] || fail "it runs as user $(id -u)"
[ -w /var/lib/earthwork ] || fail "its user cannot write to the volume"
[ ! -w /usr/local/bin/earthwork-server ] || fail "its user can write to the programs"

earthwork-server "$@" >"$log" 2>&1 </dev/null &
server=$!
port=
for _ in $(seq 100); do
  port=$(sed -n 's|.*listening on http://127\.0\.0\.1:\([0-9]*\).*|\1|p' "$log" | head -n 1)
  [ -z "$port" ] || break
  sleep 0.1
done
[ -n "$port" ] || fail "the server did not say where it listens"

earthwork-health "$port" || fail "a server that runs is not healthy"
to=(--server "http://127.0.0.1:$port" --map mine)
earthwork-bot run "$script" "${to[@]}" --create || fail "the bot cannot paint"
earthwork-bot watch "${to[@]}" --until-seq 1 || fail "the bot cannot watch"

kill -TERM "$server"
wait "$server" || fail "the server did not end well"
server=
[ -s /var/lib/earthwork/mine.earthwork ] || fail "the map is not in the volume"
! earthwork-health "$port" 2>/dev/null || fail "a server that ended is healthy"
echo "served, painted, watched and stopped"
