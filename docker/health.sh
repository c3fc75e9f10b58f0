#!/usr/bin/env bash
# Ends with 0 if the server in this container answers: health.sh [PORT]
#
# Over bash's own socket, so that the image needs no program for it.
set -euo pipefail

port=${1:-8080}
exec 3<>"/dev/tcp/127.0.0.1/$port"
printf 'GET /healthz HTTP/1.1\r\nHost: 127.0.0.1:%s\r\nConnection: close\r\n\r\n' "$port" >&3
read -r -t 4 status <&3
[[ $status == "HTTP/1.1 200 "* ]]
