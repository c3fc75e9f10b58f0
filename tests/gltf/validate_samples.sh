#!/usr/bin/env bash
# Writes sample files and holds Khronos' validator against them: validate_samples.sh WRITER FOLDER
set -euo pipefail

rm -rf "$2"
"$1" "$2"
node "$(dirname "${BASH_SOURCE[0]}")/validate.mjs" "$2"/*.glb
