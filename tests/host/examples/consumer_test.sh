#!/bin/bash
# consumer_test.sh: a project outside the tree uses the installed library and gets the same results as the program.
set -euo pipefail
project=$(cd "$(dirname "$0")/../../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cmake --install "${AXIS_BUILD:?names the build tree}" --component development --prefix "$folder/axis" > /dev/null
cp -r "$project/host/examples" "$folder/consumer"
cmake -S "$folder/consumer" -B "$folder/build" -G Ninja -DCMAKE_PREFIX_PATH="$folder/axis" --log-level=WARNING > /dev/null
ninja -C "$folder/build" > "$folder/log" || { cat "$folder/log" >&2; exit 1; }
export PATH=$(dirname "${AXISTOOL:?names the program}"):$PATH
for example in "$project"/host/examples/*.cpp; do
  name=$(basename "$example" .cpp)
  one=$("$folder/build/$name" "$project/tests/data/drive-cases/none/case-00")
  other=$("${example%.cpp}.sh" "$project/tests/data/drive-cases/none/case-00")
  echo "$name: $one"
  [ "$one" = "$other" ] || { echo "the program says: $other" >&2; exit 1; }
done
