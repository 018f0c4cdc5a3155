#!/bin/bash
# in_fresh_debian.sh PACKAGE.deb ...: installs the packages in an otherwise empty Debian 12, uses them like a user,
# removes them, and lists remaining files. As root; mmdebstrap makes the system in a temporary folder, from MIRROR.
set -euo pipefail
mirror=${MIRROR:-http://deb.debian.org/debian}
root=$(mktemp -d)
trap 'umount "$root/system/proc" 2> /dev/null || true; rm -rf "$root"' EXIT

mmdebstrap --variant=apt --include=bash-completion,fish,man-db --quiet bookworm "$root/system" "$mirror"
inside() { chroot "$root/system" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
files() { (cd "$root/system" && find etc usr opt srv var/lib -not -path 'var/lib/dpkg/*' -not -path 'var/lib/apt/*' | sort); }

mount -t proc proc "$root/system/proc"
inside apt-get -qq update
# Their dependencies are installed first, so that only the packages' own files are compared.
needs=$(for package in "$@"; do dpkg-deb -f "$package" Depends; done |
  sed -e 's/([^)]*)//g' -e 's/|[^,]*//g' -e 's/:any//g' -e 's/,/ /g' -e 's/\baxistool\b//g')
inside apt-get -qq install -y --no-install-recommends $needs > /dev/null 2>&1
files > "$root/before"
mkdir "$root/system/root/packages"
cp "$@" "$root/system/root/packages"
inside sh -c 'apt-get -qq install -y --no-install-recommends /root/packages/*.deb' > /dev/null

echo "version:    $(inside axistool --version)"
inside sh -c 'cd /root && axistool demo' > "$root/demo.txt"
echo "demo:       $(grep -c . "$root/demo.txt") lines; $(grep 'agrees with' "$root/demo.txt")"
echo "manual:     $(inside sh -c 'man axistool-identify | head -4 | tail -1')"
echo "scenario:   $(inside sh -c 'axistool hil square | tail -2 | head -1')"
echo "bash:       $(inside bash -c '. /usr/share/bash-completion/bash_completion; _completion_loader axistool
  COMP_WORDS=(axistool effects cog); COMP_CWORD=2; compopt() { :; }; _axistool; echo "${COMPREPLY[@]}"')"
echo "fish:       $(inside fish -c 'complete -C "axistool set-params x.kalman.k1"' | head -2 | cut -f1 | tr '\n' ' ')"
echo "python:     $(inside sh -c 'cd /root && python3 -c "
import axistool
print(axistool.__file__, axistool.compare(\"/usr/share/axistool/drive/model.toml\", \"/usr/share/axistool/drive/validate.csv\").combined)"')"
echo "udev rule:  $(inside cat /usr/lib/udev/rules.d/70-axis.rules | grep -c uaccess) lines give access"
inside apt-get -qq purge -y axistool python3-axistool > /dev/null
files > "$root/after"
diff "$root/before" "$root/after" > "$root/left" && echo "removed:    nothing is left" || { echo "left behind:"; cat "$root/left"; exit 1; }
