#!/usr/bin/env bash
# Runs a fuzz target of build/fuzz from its seeds: run.sh NAME. What it finds new is kept in
# build/fuzz/corpus/NAME, an input that fails in build/fuzz/failures.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
cd "$root/build/fuzz"
mkdir -p "corpus/$1" failures
folders=("corpus/$1")
if [ -d "$root/tests/fuzz/seeds/$1" ]; then
  folders+=("$root/tests/fuzz/seeds/$1")
fi
exec "bin/$1" -max_total_time="${EARTHWORK_FUZZ_SECONDS:-10}" -timeout=10 -rss_limit_mb=2048 \
  -max_len=70000 -print_final_stats=1 -artifact_prefix="failures/$1-" "${folders[@]}"
