#!/usr/bin/env bash
# Installs exactly what tests/package-lock.json names into tests/node_modules, if it is not there.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")"
if [ node_modules/.package-lock.json -nt package-lock.json ]; then
  echo "tests/node_modules is up to date"
else
  npm ci --ignore-scripts --no-audit --no-fund --fetch-retries=5 --fetch-retry-mintimeout=2000
fi
