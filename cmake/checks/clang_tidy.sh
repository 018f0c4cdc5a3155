#!/bin/sh
# Runs clang-tidy over every source file of the build tree $1 with $2 jobs; the checks are chosen in
# .clang-tidy. The Python module is compiled as one file that includes its sources.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
log=$1/clang-tidy.log
if ! run-clang-tidy-14 -clang-tidy-binary clang-tidy-14 -quiet -p "$1" -j "$2" \
  "^$root/(firmware|hal|host|sim|tests)/|/axis_python.dir/Unity/" >"$log" 2>&1; then
  sed 's,\x1b\[[0-9;]*m,,g' "$log" | grep -E 'error:|warning:' | sort -u >&2 || cat "$log" >&2
  echo "clang-tidy: findings; the whole output is in $log" >&2
  exit 1
fi
