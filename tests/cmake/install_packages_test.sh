#!/bin/sh
# Package installation: silent if all packages are installed; without root and sudo it prints the exact command and
# fails.
set -eu
folder=$(cd "$(dirname "$0")/../.." && pwd)/cmake/packages
command -v dpkg-query >/dev/null || { echo "SKIPPED: not a Debian system"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp "$folder/install.sh" "$scratch"

printf '# always present\ndpkg # comment\n\ncoreutils\n' >"$scratch/present.txt"
output=$("$scratch/install.sh" present 2>&1) || { echo "FAILED with everything installed: $output"; exit 1; }
[ -z "$output" ] || { echo "FAILED: not silent with everything installed: $output"; exit 1; }

# A PATH with the tools that the script uses, but without sudo; as a user without rights.
mkdir "$scratch/bin"
for tool in sh sed sort dpkg-query id dirname cat env; do ln -s "$(command -v $tool)" "$scratch/bin/$tool"; done
echo 'no-such-package-of-debian' >"$scratch/absent.txt"
chmod -R a+rX "$scratch"
unprivileged=
[ "$(id -u)" -ne 0 ] || unprivileged="setpriv --reuid=65534 --regid=65534 --clear-groups"
if output=$($unprivileged env PATH="$scratch/bin" "$scratch/install.sh" present absent 2>&1); then
  echo "FAILED: success although a package is missing: $output"
  exit 1
fi
case $output in
  *"apt-get update && apt-get install --no-install-recommends no-such-package-of-debian"*) ;;
  *) echo "FAILED: no command to type in: $output"; exit 1 ;;
esac
echo "package installation behaves"
