#!/bin/sh
# The include check must accept allowed includes and report every include that breaks a rule.
set -eu
check=$(cd "$(dirname "$0")/../.." && pwd)/cmake/checks/include_rules.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

fresh_tree() {
  rm -rf "$tree"
  mkdir -p "$tree/hal/pc" "$tree/firmware/core" "$tree/firmware/app" "$tree/firmware/boards/pc" "$tree/sim/effects" \
    "$tree/host/record" "$tree/host/device" "$tree/host/axistool" "$tree/tests/host"
  echo '#pragma once' >"$tree/hal/encoder.hpp"
}

accepts() {
  fresh_tree
  echo "#include $2" >"$tree/$1"
  if ! output=$("$check" "$tree"); then
    echo "FAILED: $1 may include $2, but the check says: $output"
    failures=$((failures + 1))
  fi
}

refuses() {
  fresh_tree
  printf '#include <cstdint>\n  #  include %s\n' "$2" >"$tree/$1"
  if output=$("$check" "$tree"); then
    echo "FAILED: $1 must not include $2, but the check is silent"
    failures=$((failures + 1))
  elif [ "${output#"$1:2: "}" = "$output" ]; then
    echo "FAILED: the check of $1 including $2 does not name file and line: $output"
    failures=$((failures + 1))
  fi
}

accepts hal/clock.hpp '<concepts>'
accepts hal/pc/board.hpp '"sim/plant.hpp"'
accepts firmware/core/axis.hpp '"hal/encoder.hpp"'
accepts firmware/core/axis.hpp '<cmath>'
accepts firmware/app/table.hpp '"firmware/core/axis.hpp"'
accepts firmware/boards/pc/main.cpp '"sim/plant.hpp"'
accepts sim/effects/cogging.cpp '"sim/effect.hpp"'
accepts host/record/read.cpp '"sim/drive_description.hpp"'
accepts host/device/read.cpp '"firmware/app/table.hpp"'
accepts host/record/read.cpp '"host/exit_codes.hpp"'
accepts host/axistool/main.cpp '"host/axistool/commands.hpp"'
accepts host/fourier.cpp '<fftw3.h>'
accepts tests/host/read_test.cpp '"host/axistool/commands.hpp"'

refuses hal/clock.hpp '"sim/plant.hpp"'
refuses hal/clock.hpp '"firmware/core/axis.hpp"'
refuses hal/pc/board.hpp '"firmware/core/axis.hpp"'
refuses firmware/core/axis.hpp '"sim/plant.hpp"'
refuses firmware/core/axis.hpp '"firmware/app/table.hpp"'
refuses firmware/core/axis.hpp '<vector>'
refuses firmware/app/table.hpp '"host/record/record.hpp"'
refuses firmware/boards/qemu.cpp '"sim/plant.hpp"'
refuses sim/plant.cpp '"firmware/core/axis.hpp"'
refuses sim/plant.cpp '"host/record/record.hpp"'
refuses host/record/read.cpp '"host/axistool/commands.hpp"'
refuses host/record/read.cpp '<fftw3.h>'
refuses host/record/read.cpp '"host/diagnose/verdict.hpp"'
refuses host/record/read.cpp '"firmware/boards/pc/main.hpp"'
refuses host/record/read.cpp '"record.hpp"'
refuses host/record/read.cpp '"../exit_codes.hpp"'
refuses host/record/read.cpp '<sim/plant.hpp>'

[ "$failures" -eq 0 ] || exit 1
echo "all include rules hold"
