#!/bin/sh
# fetch_newer.sh FOLDER PACKAGE...: unpacks packages of Debian 13 (newer.txt) into FOLDER/PACKAGE without installing them, so
# that Debian 12 can build with them. apt reads a list of its own with this machine's mirror and checks the signatures;
# the system's sources stay as they are. Silent and quick if nothing is missing.
set -eu
suite=trixie

packages_list=$(dirname "$0")/newer.txt
folder=$1
shift

missing=
for package in "$@"; do
  [ -d "$folder/$package" ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

fail() {
  echo "packages:$missing of Debian's suite $suite: $*" >&2
  exit 1
}

command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null || fail "this is not a Debian system"
mkdir -p "$folder"
work=$(mktemp -d -p "$folder")
trap 'rm -rf "$work"' EXIT
work=$(readlink -f "$work")
mkdir -p "$work/state/lists/partial" "$work/cache/archives/partial"
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' | head -n 1)
[ -n "$mirror" ] || fail "apt has no Debian mirror: run apt-get update first"
keys=/usr/share/keyrings/debian-archive-keyring.gpg
[ -r $keys ] || fail "$keys is missing: apt-get install debian-archive-keyring"
echo "deb [signed-by=$keys] $mirror $suite main" >"$work/sources.list"

apt="apt-get -qq -o Acquire::Retries=3 -o Acquire::Languages=none -o APT::Sandbox::User= -o Dir::Etc::SourceParts=-
  -o Dir::Etc::SourceList=$work/sources.list -o Dir::State=$work/state -o Dir::State::status=/var/lib/dpkg/status
  -o Dir::Cache=$work/cache"
$apt update >&2 || fail "the index of $mirror cannot be read; is there a network?"
for package in $missing; do
  (cd "$work" && $apt download "$package" >&2) || fail "cannot be downloaded from $mirror"
  file=$(echo "$work/$package"_*.deb)
  wanted=$(awk -v package="$package" '$1 == package { print $2 }' "$packages_list")
  if [ -n "$wanted" ] && ! echo "$wanted  $file" | sha256sum --status -c; then
    fail "$(basename "$file") is not the version that newer.txt names; test with it, then put its SHA-256 there"
  fi
  dpkg-deb -x "$file" "$work/unpacked-$package"
done
for package in $missing; do
  rm -rf "${folder:?}/$package"
  mv "$work/unpacked-$package" "$folder/$package"
done
