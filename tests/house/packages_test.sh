#!/usr/bin/env bash
# What server/packages.sh does with apt-get, seen through commands that only write down their call.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/bin"
for tool in bash env awk tr; do
  ln -s "$(command -v $tool)" "$scratch/bin/$tool"
done

fake() {
  printf '#!/bin/bash\n%s\n' "$2" >"$scratch/bin/$1"
  chmod +x "$scratch/bin/$1"
}

# try USER_ID: asks for two packages, "here" and "gone", where bash does not end at an error by
# itself; sets status, calls and output.
try() {
  fake id "echo $1"
  : >"$scratch/calls"
  status=0
  output=$(PATH=$scratch/bin bash -c "set -euo pipefail
    . '$root/server/packages.sh'
    need_packages here gone || exit \$?" 2>&1) || status=$?
  calls=$(cat "$scratch/calls")
}

expect() {
  if [ "$2" != "$3" ]; then
    printf '%s\n  expected: %s\n  got:      %s\n' "$1" "$2" "$3"
    exit 1
  fi
}

apt_get() {
  fake apt-get "echo apt-get \"\$@\" >>'$scratch/calls'; case \" \$* \" in *' -s '*) $1 ;; esac"
}

fake sleep "echo sleep \"\$@\" >>'$scratch/calls'"
options="-o DPkg::Lock::Timeout=300 -o Acquire::Retries=3"
apt_get 'true'
fake dpkg-query 'echo installed'
try 0
expect "nothing is missing" "0 " "$status $calls"

fake dpkg-query '[ "${*: -1}" = here ] && echo installed'
try 0
expect "one is missing: status" 0 "$status"
expect "one is missing: calls" "apt-get $options update -qq
apt-get install -s --no-install-recommends gone
apt-get $options install -y -q --no-remove --no-install-recommends gone" "$calls"

apt_get 'echo "Remv libboost1.74-dev [1.74.0]"; echo "Inst gone (1.0)"'
try 0
expect "Boost 1.74 is in the way: status" 2 "$status"
expect "Boost 1.74 is in the way: calls" "apt-get $options update -qq
apt-get install -s --no-install-recommends gone" "$calls"
case $output in
  *libboost1.74-dev*docker/README*) ;;
  *) expect "names the package and docker/README" "both" "$output" ;;
esac

fake apt-get "echo apt-get \"\$@\" >>'$scratch/calls'
  case \" \$* \" in *' update '*) [[ \$(<'$scratch/calls') == *sleep* ]] ;; esac"
try 0
expect "the lists are locked at first: status" 0 "$status"
expect "the lists are locked at first: calls" "apt-get $options update -qq
sleep 10
apt-get $options update -qq
apt-get install -s --no-install-recommends gone
apt-get $options install -y -q --no-remove --no-install-recommends gone" "$calls"

for step in update install; do
  fake apt-get "case \" \$* \" in *' -s '*) ;; *' $step '*) exit 100 ;; esac"
  try 0
  expect "apt-get $step fails: status" 1 "$status"
  expect "apt-get $step fails: last line" "what it said is above." "${output##*; }"
done

apt_get 'true'
try 1000
expect "no root and no sudo: status" "2 " "$status $calls"
case $output in
  *"apt-get update && apt-get install"*gone*) ;;
  *) expect "prints the line to run" "it" "$output" ;;
esac

fake sudo "echo -n 'sudo ' >>'$scratch/calls'; exec \"\$@\""
try 1000
expect "sudo: status" 0 "$status"
expect "sudo: calls" "sudo apt-get $options update -qq
apt-get install -s --no-install-recommends gone
sudo apt-get $options install -y -q --no-remove --no-install-recommends gone" "$calls"
echo "as it should be"
