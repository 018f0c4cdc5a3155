#!/bin/bash
# run.sh CACHE PROGRAM [ARGUMENT...]: runs a program of this machine as root under Debian's own kernel, in an emulated PC
# with the modules of USB/IP, HID and CP2112. The guest contains udev, a shell, and the program with its libraries.
# Output and exit code are those of the program; 77, with the reason, if the guest is not available.
# GUEST_FILES: further files and folders in the guest, separated by colons, programs with their libraries.
# GUEST_LIMIT: seconds that the guest may take (1500). GUEST_LINK: FIFOs $GUEST_LINK.in and $GUEST_LINK.out, which the
# guest sees as /dev/vport*.
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")
cache=$1
shift
PATH=$PATH:/usr/sbin:/sbin

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
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# All of the guest's files are in its memory, so it does not wait for anything outside.
root=$work/root
mkdir -p "$root$PWD"
for folder in bin lib lib64 sbin; do
  mkdir -p "$root/usr/$folder"
  [ ! -L /$folder ] || ln -s "usr/$folder" "$root/$folder"
done
IFS=: read -ra programs <<<"$(realpath -s "$(command -v "$1")"):${GUEST_FILES:-}"
for name in bash sh getent setpriv timeout udevadm /lib/systemd/systemd-udevd; do
  programs+=("$(command -v $name)") || { echo "SKIPPED: $name is not installed"; exit 77; }
done
for name in hidraw libusb; do
  programs+=($(ldconfig -p | awk -v name="libhidapi-$name.so.0" '$1 == name && /x86-64/ { print $NF }'))
done
{
  printf '%s\n' "${programs[@]}" /etc/group /etc/ld.so.cache /etc/nsswitch.conf /etc/passwd /lib/udev/rules.d
  printf '%s\n' /usr/lib/locale/C.utf8 /usr/lib/x86_64-linux-gnu/gconv/{gconv-modules.cache,UTF-16.so} # for wide texts
  { ldd "${programs[@]}" 2>/dev/null || true; } | grep -o '/[^ ]* (0x' | cut -d ' ' -f 1
} | sort -u | xargs -d '\n' cp -Lr --parents -t "$root"
printf 'export ASAN_OPTIONS=%q UBSAN_OPTIONS=%q; cd %q; exec %s\n' "${ASAN_OPTIONS:-}" "${UBSAN_OPTIONS:-}" "$PWD" \
  "$(printf '%q ' "$@")" >"$root/command"
{
  cat "$kernel/initrd"
  cd "$root" && find . | cpio -o -H newc -R 0:0 --quiet
} >"$work/initrd"

# Without /dev/kvm, which hangs if it is itself emulated. The guest's clock counts its instructions, 10^9 a second, so
# that the guest misses no event on a loaded computer. Idle time is skipped, except while it waits for something
# outside. Emulation is fastest with a plain processor, with programs at the same
# addresses each time (translated code is reused), and without calibration of the processor's timer.
link=()
waiting=off
if [ -n "${GUEST_LINK:-}" ]; then
  link=(-chardev "pipe,id=link,path=$GUEST_LINK" -device virtio-serial -device virtserialport,chardev=link)
  waiting=on
fi
timeout "${GUEST_LIMIT:-1500}" $emulator -accel tcg -icount shift=0,sleep=$waiting -cpu qemu64 -machine pc -smp 1 -m 768 \
  -nodefaults -no-reboot -nographic -serial stdio -monitor none -kernel "$kernel/vmlinux" -initrd "$work/initrd" \
  -append "console=ttyS0 quiet loglevel=3 panic=-1 mitigations=off norandmaps nolapic_timer" "${link[@]}" </dev/null |
  sed -u 's/\r//g' | tee "$work/console" | sed -u -e '1,/guest: started$/d' -e '/^guest: ended with/,$d' || status=$?
code=$(sed -n 's/^guest: ended with //p' "$work/console" | tail -n 1)
if [ -z "$code" ]; then
  cat "$work/console"
  echo "guest: it ended without an exit code (status $status)"
  exit 1
fi
exit "$code"
