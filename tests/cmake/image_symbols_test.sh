#!/bin/sh
# The image check finds heap, double precision and size, and lets a clean image pass.
set -eu
check=$(dirname "$0")/../../cmake/checks/image_symbols.sh
command -v arm-none-eabi-gcc >/dev/null || { echo "skipped: arm-none-eabi-gcc is not installed"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

build() {  # build NAME SOURCE
  echo "$2" >"$folder/$1.c"
  arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -O1 --specs=nosys.specs -nostartfiles -Wl,-e,run -Wl,--no-warnings \
    "$folder/$1.c" -o "$folder/$1.elf" 2>/dev/null ||
    arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -O1 --specs=nosys.specs -nostartfiles -Wl,-e,run "$folder/$1.c" -o "$folder/$1.elf" 2>/dev/null
}
run_check() { "$check" arm-none-eabi-nm arm-none-eabi-size "${2:-65536}" 32768 "$folder/$1.elf" >"$folder/log" 2>&1; }

build clean 'int value; int run(void) { return value += 3; }'
build heap '#include <stdlib.h>
void *run(unsigned n) { return malloc(n); }'
build twice 'double value; double run(double x) { return x * value; }'

run_check clean || { echo "a clean image is refused"; cat "$folder/log"; exit 1; }
for bad in heap twice; do
  if run_check "$bad"; then echo "$bad is not found"; exit 1; fi
done
if run_check clean 8; then echo "an image above the limit passes"; exit 1; fi
