#!/usr/bin/env bash
# clang-tidy over the files that suspend (.clang-tidy says which checks): tidy.sh BUILD_FOLDER
set -euo pipefail

build=$1
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mapfile -t files < <(grep -rlE --include='*.cpp' '\bco_(await|return|yield)\b' server client protocol)
if [ ${#files[@]} -eq 0 ]; then
  echo "no file has co_await"
  exit 1
fi
echo "clang-tidy on ${files[*]}"
printf '%s\0' "${files[@]}" | xargs -0 -n1 -P2 clang-tidy-19 -p "$build" --quiet
