#!/bin/sh
# mutants.sh ROOT LIBRARIES CXX all|few|DRIVER: seeds the mistakes of mutants.txt into the drivers, one at a time, and fails
# unless the driver's test fails with each. The list has an error if a mistake does not compile, or if its text does not
# occur exactly once. `few` tries the first mistake of each driver, DRIVER all mistakes of one driver.
set -eu
root=$1 libraries=$2 cxx=$3 which=$4
jobs=$(nproc)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

flags="-std=c++20 -O0 -w -DAXIS_REGISTERS_ANSWERED -DAXIS_TEST_DATA=\"$root/tests/data\" \
  -DAXIS_BOARD=\"firmware/boards/axis-f405/board.hpp\""
printf '#include <gtest/gtest.h>\n' >"$work/common.hpp"
# shellcheck disable=SC2086
"$cxx" $flags -x c++-header "$work/common.hpp" -o "$work/common.hpp.gch"

# One numbered folder for each mistake: the changed source, the name of the test, and the sources compiled with both.
awk -v root="$root" -v work="$work" -v which="$which" '
  function trimmed(text) { gsub(/^ +| +$/, "", text); return text }
  function meant(text) { text = trimmed(text); gsub(/`pipe`/, "|", text); gsub(/`or`/, "||", text); gsub(/\\n/, "\n", text); return text }
  /^#/ || /^ *$/ { next }
  /^@/ { driver = substr($0, 3); mistakes = 0; next }
  {
    if (split($0, part, "|") != 4) { print "mutants.txt:" NR ": not four parts: " $0; exit 1 }
    if (which == "few" ? mistakes++ > 0 : which != "all" && which != driver) next
    source = trimmed(part[2]); text = meant(part[3]); other = meant(part[4])
    whole = ""
    while ((getline line < (root "/" source)) > 0) whole = whole line "\n"
    close(root "/" source)
    place = index(whole, text)
    if (place == 0 || index(substr(whole, place + 1), text) != 0) {
      print "mutants.txt:" NR ": \"" text "\" is not there once in " source; bad = 1; next
    }
    folder = sprintf("%s/%03d", work, ++count)
    directory = folder "/" source; sub(/\/[^\/]*$/, "", directory)
    system("mkdir -p " directory)
    printf "%s", substr(whole, 1, place - 1) other substr(whole, place + length(text)) >(folder "/" source)
    close(folder "/" source)
    print root "/tests/" trimmed(part[1]) >(folder "/test")
    print driver ": " trimmed(part[3]) " -> " trimmed(part[4]) >(folder "/what")
    too = part[1] ~ /axis_f405/ ? "axis-f405/board.cpp" : part[1] ~ /program_test/ ? \
      "axis-f405/board.cpp program/main.cpp program/control.cpp image/survival_record.cpp" : ""
    for (i = split(too, others, " "); i > 0; --i) {
      other = "firmware/boards/" others[i]
      print (source == other ? folder : root) "/" other >(folder "/too")
    }
    if (too == "") printf "" >(folder "/too")
    close(folder "/test"); close(folder "/what"); close(folder "/too")
  }
  END { exit bad }' "$root/tests/hal/mutants.txt"

cat >"$work/try.sh" <<'END'
folder=$1
if ! $CXX $FLAGS -include "$WORK/common.hpp" -I"$folder" -I"$ROOT" "$(cat "$folder/test")" $(cat "$folder/too") $LIBRARIES -lgtest_main -lgtest -lrapidcheck -pthread \
  -o "$folder/program" 2>"$folder/errors"; then
  echo "does not compile: $(cat "$folder/what")"
  head -5 "$folder/errors"
elif timeout 120 "$folder/program" >"$folder/output" 2>&1; then
  echo "survives: $(cat "$folder/what")"
else
  rm -f "$folder/program"
  exit 0
fi
rm -f "$folder/program"
exit 1
END
export WORK="$work" ROOT="$root" LIBRARIES="$libraries" CXX="$cxx" FLAGS="$flags"
tried=$(find "$work" -name what | wc -l)
if find "$work" -name what | sed 's,/what$,,' | sort | xargs -P "$jobs" -n 1 sh "$work/try.sh"; then
  echo "mutants: all $tried mistakes were found"
else
  exit 1
fi
