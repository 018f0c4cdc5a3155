#!/bin/bash
# with_cortex_m.sh IMAGE.elf CACHE PROGRAM [ARGUMENT...]: runs run.sh and, beside it, the emulated Cortex-M board, whose
# reports the guest sees at /dev/vport*. The board's emulator is outside the guest, because an emulator inside an
# emulator is too slow for 1 kHz. The board's clock counts its instructions, 250 million a second, so that it misses no
# control period on a loaded computer; while the board is idle, real time counts. The bridge in the guest reports the
# guest's time to the board, which waits when it is ahead.
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")
image=$(readlink -m "$1")  # the folder may be missing too
shift

if ! command -v qemu-system-arm >/dev/null || [ ! -e "$image" ]; then
  echo "SKIPPED: qemu-system-arm, or $image (make firmware), is missing"
  exit 77
fi
folder=$(mktemp -d)
mkfifo "$folder/link.in" "$folder/link.out"
exec 8<>"$folder/link.in" 9<>"$folder/link.out" # so that no program waits until another opens them
cat <"$folder/link.out" >"$folder/to_board" 8>&- 9>&- &
copier=$!
(cd "$folder" && exec qemu-system-arm -M mps2-an386 -device loader,file="$image",cpu-num=0 -display none -monitor none -serial none \
  -icount shift=2,sleep=on -semihosting-config enable=on,target=native </dev/null >/dev/null 2>&1) &
board=$!
disown -a
trap 'kill -KILL $board $copier 2>/dev/null || true; rm -rf "$folder"' EXIT
GUEST_LINK=$folder/link "$here/run.sh" "$@"
