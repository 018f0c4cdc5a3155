#!/bin/bash
# wheel_check.sh WHEEL: installs the wheel in a Debian 12 that holds Python, NumPy and pip and neither a compiler nor any
# library of the package, and identifies, compares and reads a model with it. As root; mmdebstrap makes the system, from
# MIRROR.
set -euo pipefail
mirror=${MIRROR:-http://deb.debian.org/debian}
drive=$(cd "$(dirname "$0")/../.." && pwd)/tests/data/drive-cases/none/case-00
root=$(mktemp -d)
trap 'umount "$root/system/proc" 2> /dev/null || true; rm -rf "$root"' EXIT

mmdebstrap --variant=apt --include=python3-minimal,python3-numpy,python3-pip --aptopt='APT::Install-Recommends "false"' \
  --quiet bookworm "$root/system" "$mirror"
inside() { chroot "$root/system" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 "$@"; }
mount -t proc proc "$root/system/proc"
mkdir "$root/system/root/given"
cp "$1" "$drive"/*.csv "$drive"/model.toml "$root/system/root/given"
if inside which gcc g++ cmake; then echo "a compiler is in the system that should have none" >&2; exit 1; fi
inside sh -c 'pip install --quiet --no-index --no-deps --break-system-packages --root-user-action=ignore /root/given/*.whl'
inside python3 - << 'EOF'
import axistool
given = "/root/given/"
model = axistool.Model.read(given + "model.toml")
found = axistool.identify(given + "train-jog.csv", drive=model)
error = axistool.compare(model, given + "validate.csv")
inertia = found.model.effect("inertia")["J_kg_m2"]
print(f"{axistool.__file__}: J {inertia:.4g} kg m^2; {error.combined:.3g} times the noise floor")
EOF
