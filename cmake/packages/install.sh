#!/bin/sh
# install.sh LIST...: installs the Debian packages of these lists that are missing, e.g. install.sh build test
# Silent and quick if nothing is missing.
set -eu

lists_folder=$(dirname "$0")

listed() {
  for list in "$@"; do
    sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$lists_folder/$list.txt"
  done | sort -u
}

if ! command -v dpkg-query >/dev/null 2>&1; then
  echo "packages: this is not a Debian system; install the equivalents of:" $(listed "$@") >&2
  exit 0
fi

wanted=$(listed "$@")
installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' $wanted 2>/dev/null | sed -n 's/^installed //p' | sort -u)
missing=
for package in $wanted; do
  case "
$installed
" in
    *"
$package
"*) ;;
    *) missing="$missing $package" ;;
  esac
done
[ -n "$missing" ] || exit 0

if [ "$(id -u)" -eq 0 ]; then
  as_root=
elif command -v sudo >/dev/null 2>&1 && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
  as_root=sudo
else
  echo "packages: missing:$missing" >&2
  echo "packages: this needs root or sudo. Let an administrator run this once, then repeat:" >&2
  echo "  apt-get update && apt-get install --no-install-recommends$missing" >&2
  exit 1
fi

echo "packages: installing$missing"
apt="$as_root env DEBIAN_FRONTEND=noninteractive apt-get -o Acquire::Retries=3 -o DPkg::Lock::Timeout=600 -qq"
$apt update </dev/null || echo "packages: the package index could not be updated; trying with the old one" >&2
if ! $apt install -y --no-install-recommends -o Dpkg::Use-Pty=0 $missing </dev/null >/dev/null; then
  echo "packages: installation failed; see above. By hand: apt-get install --no-install-recommends$missing" >&2
  exit 1
fi
