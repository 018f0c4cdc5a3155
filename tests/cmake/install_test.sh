#!/bin/bash
# install_test.sh: the installed files work from their location: program, shipped scenarios, manual, completions, rule.
set -euo pipefail
build=${AXIS_BUILD:?names the build tree}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "$1" >&2; exit 1; }

DESTDIR=$folder/stage cmake --install "$build" --component axistool --prefix /opt/axis > /dev/null
place=$folder/stage/opt/axis
mv "$place" "$folder/moved" # nothing may depend on where it was built or installed
program=$folder/moved/bin/axistool
"$program" hil --list | grep -q '^hidden-effect ' || fail "the shipped scenarios are not found"
"$program" hil square > "$folder/out" || fail "the shipped scenario does not run: $(cat "$folder/out")"
test -f "$folder/moved/share/axistool/drive/train-steps.csv" || fail "the demonstration's record is missing"
gzip -dc "$folder/moved/share/man/man1/axistool-hil.1.gz" | grep -q '^.SH NAME' || fail "the manual is missing"
for file in share/bash-completion/completions/axistool share/fish/vendor_completions.d/axistool.fish \
  lib/udev/rules.d/70-axis.rules share/doc/axistool/copyright; do
  test -s "$folder/moved/$file" || fail "$file is missing"
done
