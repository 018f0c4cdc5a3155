#!/bin/bash
# examples_test.sh: every example runs in the shell and in Python, and both print the same result.
set -euo pipefail
/usr/bin/python3 -c 'import numpy' 2> /dev/null || { echo "python3-numpy is missing" >&2; exit 77; }
project=$(cd "$(dirname "$0")/../../.." && pwd)
export PATH=$(dirname "${AXISTOOL:?names the program}"):$PATH
drive=$project/tests/data/drive-cases/none/case-00
pages=$(mktemp -d)
trap 'rm -rf "$pages"' EXIT
count=0
for shell in "$project"/host/examples/*.sh; do
  python=${shell%.sh}.py
  one=$("$shell" "$drive" "$pages") other=$("$python" "$drive")
  echo "$(basename "$shell" .sh): $one"
  if [ -z "$one" ] || [ "$one" != "$other" ]; then
    echo "$python prints: $other" >&2
    exit 1
  fi
  # README's table lists each example with the first digits of its result.
  row=$(grep "^| $(basename "$shell" .sh) " "$project/host/examples/README.md") || { echo "README.md does not name it" >&2; exit 1; }
  figure=$(sed 's/.*`\([^`]*\)` |$/\1/' <<< "$row")
  [[ $one == "${figure%…}"* ]] || { echo "README.md says: $figure" >&2; exit 1; }
  count=$((count + 1))
done
test "$count" -ge 4
for page in 02-compare 03-mass-off; do grep -q '<svg\|plot-0' "$pages/$page.html"; done
