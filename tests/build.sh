#!/usr/bin/env bash
# Configures one of the presets and builds a target of it: build.sh PRESET TARGET
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
# shellcheck source=server/packages.sh
. server/packages.sh
use_ccache "$root"

log=$(mktemp)
trap 'rm -f "$log"' EXIT
# Ninja's own lines are thousands; they are of interest when the build fails.
if ! { cmake --preset "$1" && cmake --build "build/$1" --target "$2"; } >"$log" 2>&1; then
  grep -v '^\[[0-9]*/[0-9]*\] ' "$log" >&2
  echo "The build of $2 in build/$1 failed." >&2
  exit 1
fi
