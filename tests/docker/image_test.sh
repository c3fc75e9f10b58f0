#!/usr/bin/env bash
# Builds docker/Dockerfile with buildah and runs what comes of it. Neither a daemon nor a registry
# of images is needed: a base that is not there is made from Debian's packages, and kept.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
# shellcheck source=server/packages.sh
. "$root/server/packages.sh"
base=docker.io/library/debian:bookworm-slim
image=localhost/earthwork-test
max_size_mb=130
export BUILDAH_ISOLATION=chroot

fail() {
  echo "$1" >&2
  exit 1
}

containers=()
scratch=$(mktemp -d)
clean_up() {
  [ ${#containers[@]} -eq 0 ] || buildah rm "${containers[@]}" >/dev/null || true
  buildah rmi "$image" >/dev/null 2>&1 || true
  rm -rf "$scratch"
}

# new_container IMAGE: its name in $container.
new_container() {
  container=$(buildah from --pull-never "$1")
  containers+=("$container")
}

# What is published under that name: a minimal Debian without documentation.
make_base() {
  local no_docs=etc/dpkg/dpkg.cfg.d/no-docs tree=$scratch/base
  debootstrap --variant=minbase bookworm "$tree"
  printf 'path-exclude /usr/share/%s/*\n' doc man locale info >"$tree/$no_docs"
  rm -rf "$tree"/usr/share/{doc,man,locale,info}/* \
    "$tree"/var/{cache/apt,lib/apt/lists}/* "$tree"/var/log/*
  new_container scratch
  tar -C "$tree" --one-file-system --exclude='./dev/*' -c . |
    tar -C "$(buildah mount "$container")" -x
  buildah config --cmd bash "$container"
  buildah commit --quiet "$container" "$base" >/dev/null
}

build_image() {
  # The format that has health checks; buildah's own has none.
  buildah build --format docker --network=host --pull-never \
    --ignorefile "$root/docker/Dockerfile.dockerignore" -f "$root/docker/Dockerfile" \
    -t "$image" "$root"
}

# expect_config FIELD TEXT
expect_config() {
  local is
  is=$(buildah inspect --type image --format "{{.Docker.Config.$1}}" "$image")
  [ "$is" = "$2" ] || fail "$1 of the image is $is, not $2"
}

check_config() {
  expect_config User 900:900
  expect_config Entrypoint '[earthwork-server]'
  expect_config Healthcheck.Test '[CMD earthwork-health]'
  expect_config Volumes 'map[/var/lib/earthwork:{}]'
  expect_config ExposedPorts 'map[8080/tcp:{}]'
}

check_size() {
  local size_mb
  size_mb=$(du -sx --block-size=1MB "$(buildah mount "$container")" | cut -f 1)
  echo "the image holds $size_mb MB"
  [ "$size_mb" -le $max_size_mb ] || fail "that is beyond $max_size_mb MB"
}

# Runs the image's own command, but on a port that is free and on this machine only.
check_run() {
  local command words='{{range .Docker.Config.Cmd}}{{.}} {{end}}'
  command=$(buildah inspect --type image --format "$words" "$image")
  [[ $command == *" 0.0.0.0:8080 "* ]] || fail "the image does not listen where it should: $command"
  # shellcheck disable=SC2086  # a word is an argument
  buildah run --volume "$root/tests:/tests:ro" "$container" -- \
    bash /tests/docker/inside.sh ${command/0.0.0.0:8080/127.0.0.1:0}
}

[ "$(id -u)" -eq 0 ] || fail "This test wants root: it builds in a chroot."
need_packages buildah debootstrap
trap clean_up EXIT
buildah inspect --type image "$base" >/dev/null 2>&1 || make_base
build_image
check_config
new_container "$image"
check_size
check_run
