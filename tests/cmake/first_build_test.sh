#!/bin/bash
# first_build_test.sh: `make` requires no package of the tests or of the Python module, configures without them, and
# builds only the program.
set -euo pipefail
project=$(cd "$(dirname "$0")/../.." && pwd)
build=${AXIS_BUILD:?names the build tree}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
fail() { echo "$1" >&2; exit 1; }

listed() { sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$@" | sort; }
cd "$project/cmake/packages"
twice=$(comm -12 <(listed build.txt) <(listed python.txt test.txt lint.txt bench.txt))
[ -z "$twice" ] || fail "make installs what it does not need: $twice"

cd "$project"
recipe=$(make -n all | grep ninja)
[[ $recipe == *" axistool" ]] || fail "make builds more than the program: $recipe"
cmake -S cmake -B "$scratch" -G Ninja --log-level=WARNING "-DAXIS_PACKAGES=$build/packages" -DAXIS_UNITY=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_{GTest,rapidcheck,pybind11,Python3}=ON > "$scratch/log" 2>&1 ||
  fail "the program does not configure by itself: $(cat "$scratch/log")"
targets=$(ninja -C "$scratch" -t targets all)
grep -q '^bin/axistool:' <<< "$targets" || fail "there is no axistool to build"
! grep -qE 'test_host|axis_python' <<< "$targets" || fail "there are tests or a Python module without their packages"
