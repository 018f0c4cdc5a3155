#!/bin/bash
# run.sh CACHE PROGRAM [ARGUMENT...]: runs a program of this machine as root under Debian's own kernel, in an emulated PC
# with the modules of USB/IP, HID and CP2112. The program sees this machine's files read-only; /run and /tmp are its own.
# Its output and its exit code are this script's; 77 where the guest cannot be had, with the reason.
# GUEST_LIMIT: seconds that the guest may take (1500). GUEST_LINK: a Unix socket that the guest sees as /dev/vport*.
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")
cache=$1
shift

# Without /dev/kvm: where it is itself emulated, it hangs. The guest's time goes by its instructions, a thousand million a
# second, and by the clock only while it waits: a loaded computer makes it slow, but makes it miss nothing.
emulator=qemu-system-x86_64
if ! command -v $emulator >/dev/null; then
  echo "SKIPPED: $emulator is not installed"
  exit 77
fi
status=0
kernel=$("$here/kernel.sh" "$cache") || status=$?
if [ "$status" -ne 0 ]; then
  [ "$status" -ne 77 ] || echo "SKIPPED: the guest has no kernel"
  exit "$status"
fi

link=()
[ -z "${GUEST_LINK:-}" ] || link=(-chardev "socket,id=link,path=$GUEST_LINK" -device virtio-serial
  -device virtserialport,chardev=link)
shared=$(mktemp -d)
trap 'rm -rf "$shared"' EXIT
readlink -f "$here/../.." >"$shared/project"
printf 'cd %q; exec %s\n' "$PWD" "$(printf '%q ' "$@")" >"$shared/command"
timeout "${GUEST_LIMIT:-1500}" $emulator -accel tcg -icount shift=0,sleep=on -cpu max -machine pc -smp 1 \
  -m 512 -nodefaults -no-reboot -nographic -serial stdio -monitor none -kernel "$kernel/vmlinux" -initrd "$kernel/initrd.gz" \
  -append "console=ttyS0 quiet loglevel=3 panic=-1" \
  -virtfs local,path=/,mount_tag=root,security_model=none,readonly=on,multidevs=remap \
  -virtfs local,path="$shared",mount_tag=shared,security_model=none "${link[@]}" </dev/null |
  tr -d '\r' | sed -e '1,/guest: started$/d' -e '/reboot: Power down$/d' || status=$?
if [ ! -e "$shared/exit_code" ]; then
  echo "guest: it ended without an exit code (status $status)"
  exit 1
fi
code=$(cat "$shared/exit_code")
[ "$code" = 0 ] || sed 's/^/kernel: /' "$shared/kernel.log"
exit "$code"
