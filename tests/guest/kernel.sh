#!/bin/bash
# kernel.sh CACHE: downloads and unpacks Debian's kernel and a static busybox, without installing them, and makes the
# files that the guest boots: vmlinux and initrd. Prints their folder, CACHE/VERSION; does nothing if they exist.
# Exit code 77, with the reason on standard error, if the packages are not available.
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")
mkdir -p "$1"
cache=$(readlink -f "$1")
PATH=$PATH:/usr/sbin:/sbin

modules="virtio_pci virtio_console vhci-hcd usbhid hid-generic uhid hid-cp2112"

skip() {
  echo "guest: $*" >&2
  exit 77
}

for tool in apt-get dpkg-deb cpio modinfo xz; do
  command -v $tool >/dev/null || skip "$tool is not installed"
done

# apt is the slowest part; its answer is kept until its lists change.
scripts=$(cat "$here/init.sh" "$here/kernel.sh" | sha256sum | cut -c 1-12)
answer=$cache/folder-$scripts
if [ "$answer" -nt /var/lib/apt/lists ] && [ -e "$(cat "$answer")/initrd" ]; then
  cat "$answer"
  exit 0
fi

package=$(apt-cache depends linux-image-amd64 2>/dev/null | awk '/Depends:/ { print $2; exit }')
[ -n "$package" ] || skip "apt knows no package linux-image-amd64: apt-get update"
version=$(apt-cache show --no-all-versions "$package" | awk '/^Version:/ { print $2 }')
folder=$cache/$package-$version-$scripts

exec 9>"$cache/lock"
flock 9
if [ -e "$folder/initrd" ]; then
  echo "$folder" | tee "$answer"
  exit 0
fi

work=$(mktemp -d -p "$cache")
trap 'rm -rf "$work"' EXIT
cd "$work"
apt-get -qq -o Acquire::Retries=3 -o APT::Sandbox::User= download "$package" busybox-static >&2 ||
  skip "the packages $package and busybox-static cannot be downloaded: apt-get update"
dpkg-deb --fsys-tarfile busybox-static_*.deb | tar x ./bin/busybox
dpkg-deb --fsys-tarfile "$package"_*.deb | tar x --wildcards './boot/vmlinuz-*' './lib/modules/*/kernel/drivers/usb/*' \
  './lib/modules/*/kernel/drivers/hid/*' './lib/modules/*/kernel/drivers/virtio/*' './lib/modules/*/kernel/drivers/char/virtio_console*'

# A kernel that is decompressed here boots 3 s faster. xz warns about the bytes after the compressed kernel.
offset=$(LC_ALL=C grep -abo -m 1 -P '\xfd7zXZ\x00' boot/vmlinuz-* | head -n 1 | cut -d : -f 1 || true)
if [ -n "$offset" ]; then
  tail -c +$((offset + 1)) boot/vmlinuz-* | xz -dc --single-stream >vmlinux 2>/dev/null || true
fi
[ "$(head -c 4 vmlinux 2>/dev/null)" = $'\x7fELF' ] || cp boot/vmlinuz-* vmlinux

mkdir -p root/busybox root/modules
cp bin/busybox root/busybox/
install -m 755 "$here/init.sh" root/init

# Each module after the modules that it needs. Modules without a file are built into the kernel.
declare -A added=()
add_module() {
  local name=${1//-/_} file needed
  [ -z "${added[$name]:-}" ] || return 0
  added[$name]=1
  file=$(find lib/modules -name "${name//_/[-_]}.ko*" -print -quit)
  [ -n "$file" ] || return 0
  for needed in $(modinfo -F depends "$file" | tr , ' '); do add_module "$needed"; done
  case $file in
    *.xz) xz -dc "$file" >"root/modules/$name.ko" ;;
    *) cp "$file" "root/modules/$name.ko" ;;
  esac
  echo "$name.ko" >>root/modules/order
}
for module in $modules; do add_module "$module"; done

mkdir finished
(cd root && find . | LC_ALL=C sort | cpio -o -H newc --quiet) >finished/initrd
mv vmlinux finished/
rm -rf "$folder"
mv finished "$folder"
echo "$folder" | tee "$answer"
