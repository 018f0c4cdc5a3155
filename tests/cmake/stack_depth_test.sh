#!/bin/sh
# The stack check sums frames along calls, including calls through pointers, and reports calls that it cannot sum.
set -eu
check=$(dirname "$0")/../../cmake/checks/stack_depth.sh
command -v arm-none-eabi-gcc >/dev/null || { echo "skipped: arm-none-eabi-gcc is not installed"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

build() {  # build NAME SOURCE
  mkdir "$folder/$1"
  echo "$2" >"$folder/$1/source.c"
  arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -O1 -fno-inline -fno-optimize-sibling-calls -fstack-usage -fcallgraph-info=su \
    -c "$folder/$1/source.c" -o "$folder/$1/source.o"
}
run_check() { name=$1; shift; "$check" "$folder/$name" "$@" >"$folder/log" 2>&1; }
refuse() { if run_check "$@"; then echo "passes: $*"; cat "$folder/log"; exit 1; fi; }
pass() { run_check "$@" || { echo "is refused: $*"; cat "$folder/log"; exit 1; }; }

build calls 'void use(char*); void use(char* x) { __asm volatile("" :: "r"(x)); }
void deep(void) { char big[400]; use(big); } void run(void) { deep(); }'
pass calls 1000 run
refuse calls 300 run
refuse calls 1000 walk

build recursion 'int run(int n) { return n ? 1 + run(n - 1) : 0; }'
refuse recursion 1000 run

build pointer 'void use(char*); void use(char* x) { __asm volatile("" :: "r"(x)); }
void handler(void) { char big[400]; use(big); } void (*volatile go)(void) = handler; void run(void) { go(); go(); }'
refuse pointer 1000 run
pass pointer 1000 run via:handler
refuse pointer 300 run via:handler
refuse pointer 1000 run via:nobody

build unseen 'void elsewhere(void); void run(void) { elsewhere(); elsewhere(); }'
refuse unseen 1000 run
pass unseen 1000 run absent:elsewhere
echo "the stack check finds what it should"
