#!/usr/bin/env bash
# The wire means the same in the page as natively: wire_test.sh NATIVE_WIRE. The golden files hold
# the chunks' hashes too, as text that neither of the programs reads.
set -euo pipefail

native=$1
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
golden=$root/tests/protocol/golden
web=$root/build/web/bin/wire.js

scratch=$(mktemp)
trap 'rm -f "$scratch"' EXIT

fail() {
  printf '%s\n' "$@"
  exit 1
}

for chunk in square bend band empty; do
  hash=$(sed -n 's/.*, mesh hash \([0-9a-f]\{16\}\)$/\1/p' "$golden/$chunk.hex")
  here=$("$native" <"$golden/$chunk.hex")
  there=$(node "$web" <"$golden/$chunk.hex" 2>"$scratch") || fail "$(tail -n 20 "$scratch")"
  [ "$here" = "$there" ] || fail "$chunk differs" "native: $here" "page:   $there"
  case $there in "mesh hash $hash,"*) ;; *) fail "$chunk has the hash $hash" "page: $there" ;; esac
done

for messages in client server; do
  diff <("$native" <"$golden/$messages.jsonl") <(node "$web" <"$golden/$messages.jsonl") ||
    fail "the page writes $messages messages in another way"
done
echo "as it should be"
