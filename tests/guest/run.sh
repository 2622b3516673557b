#!/bin/bash
# Runs the tests of SocketCAN (tests/socketcan) against a real kernel: directly where this machine's has
# CAN, in a network namespace of its own, and in the guest, which also has the CAN controllers.
#
#   tests/guest/run.sh BIN    the folder of the executables, such as build/dev/bin
set -euo pipefail
bin=$(cd "$1" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

own_namespace=(unshare --net)
((EUID == 0)) || own_namespace+=(--map-root-user)
if "${own_namespace[@]}" ip link add vcan0 type vcan 2>/dev/null; then
  echo "this machine's kernel has CAN: vcan directly"
  "${own_namespace[@]}" "$bin/tests_socketcan" --gtest_filter='-Sja1000*'
else
  echo "this machine's kernel has no CAN: vcan and sja1000 in the guest"
fi
tests/guest/boot.sh "$bin/tests_socketcan"
