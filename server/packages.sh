# The Debian packages that the project is built with, and how they are installed. Sourced by
# server/run and tests/run.
# shellcheck shell=bash

# shellcheck disable=SC2034  # read by the scripts that source this one
server_packages=(
  cmake ninja-build ccache clang-19 lld-19
  libboost1.81-dev libboost-url1.81-dev nlohmann-json3-dev libtinygltf-dev libxxhash-dev
  libspdlog-dev libfmt-dev libcli11-dev libexpected-dev libpng-dev libsodium-dev
  prometheus-cpp-dev libsqlite3-dev
)
# What the page is built with beside the above; emscripten brings node.
# shellcheck disable=SC2034
page_packages=(emscripten zopfli)
# llvm-19 holds the symbolizer that makes a sanitizer's stack traces readable.
# shellcheck disable=SC2034
test_packages=(
  clang-tidy-19 libclang-rt-19-dev llvm-19 clang-format-14
  libgtest-dev librapidcheck-dev libbenchmark-dev libepoxy-dev libegl-dev libegl1 libgl1-mesa-dri
  chromium fonts-dejavu-core libgles2
)

is_installed() {
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# need_packages PACKAGE...: installs those that are missing; without any, apt-get is not called.
# Nothing is ever removed: what stands in the way is named, and the script ends with status 2; with
# 1 when apt-get fails. (It says so itself: where a caller looks at its status, bash has no errexit.)
need_packages() {
  local package missing=() as_root=() in_the_way
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  local install=(install -y -q --no-remove --no-install-recommends "${missing[@]}")
  if [ "$(id -u)" -ne 0 ]; then
    as_root=(sudo)
    if ! command -v sudo >/dev/null; then
      echo "Packages are missing. Run this as root:" >&2
      echo "  apt-get update && apt-get ${install[*]}" >&2
      exit 2
    fi
  fi

  echo "== installing ${missing[*]}"
  # A machine that has just started may be updating itself: the timeout is for the lock on the
  # packages; the one on their lists is not waited for by apt-get.
  local apt_get=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive
    apt-get -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3)
  local tries=6
  until "${apt_get[@]}" update -qq </dev/null; do
    [ $((tries -= 1)) -gt 0 ] || failed_to "read the lists of packages"
    sleep 10
  done
  in_the_way=$(apt-get install -s --no-install-recommends "${missing[@]}" 2>/dev/null |
    awk '$1 == "Remv" { print $2 }' | tr '\n' ' ') || true
  if [ -n "$in_the_way" ]; then
    echo "In the way, and not removed: $in_the_way" >&2
    echo "Of Boost 1.81 and 1.74 only one can be installed for development." >&2
    echo "docker/README says how to build beside what is installed." >&2
    exit 2
  fi
  "${apt_get[@]}" "${install[@]}" </dev/null >/dev/null || failed_to "install ${missing[*]}"
}

failed_to() {
  echo "apt-get failed to $1; what it said is above." >&2
  exit 1
}

# use_ccache ROOT: ccache finds what another clone of the project on this machine has built, and a
# folder to write to where there is no home.
use_ccache() {
  export CCACHE_BASEDIR=$1 CCACHE_NOHASHDIR=1
  if [ -z "${CCACHE_DIR:-}" ] && { [ -z "${HOME:-}" ] || [ ! -w "$HOME" ]; }; then
    export CCACHE_DIR=$1/build/ccache
  fi
}
