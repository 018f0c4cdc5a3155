#!/bin/bash
# with_cortex_m.sh IMAGE.elf CACHE PROGRAM [ARGUMENT...]: run.sh, and beside it the emulated Cortex-M board, whose serial
# port the guest sees as /dev/vport*. Beside it, because an emulator inside an emulator is too slow for 1 kHz. Its time
# goes by its instructions, 250 million a second: on a loaded computer it runs slowly, but misses no control period.
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")
image=$1
shift

if ! command -v qemu-system-arm >/dev/null || [ ! -e "$image" ]; then
  echo "SKIPPED: qemu-system-arm, or $image (make firmware), is missing"
  exit 77
fi
folder=$(mktemp -d)
qemu-system-arm -M netduinoplus2 -kernel "$image" -display none -monitor none -icount shift=2,align=off,sleep=off \
  -serial "unix:$folder/serial,server=on" \
  </dev/null >/dev/null 2>&1 &
board=$!
trap 'kill $board 2>/dev/null || true; rm -rf "$folder"' EXIT
while [ ! -S "$folder/serial" ] && kill -0 $board; do sleep 0.05; done
GUEST_LINK=$folder/serial "$here/run.sh" "$@"
