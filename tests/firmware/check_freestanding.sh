#!/bin/sh
# Usage: check_freestanding.sh OBJECT NM OBJDUMP PROCESSOR
# Fails when the object calls anything but the compiler's own memory functions, or computes in double precision.
set -eu
object=$1 nm=$2 objdump=$3 processor=$4

needed=$("$nm" --undefined-only --format=posix "$object" | cut -d' ' -f1 |
  grep -v -E '^(memcpy|memset|memmove|memcmp|_GLOBAL_OFFSET_TABLE_)$' || true)
if [ -n "$needed" ]; then
  echo "the control core calls: $needed" >&2
  exit 1
fi

"$nm" --defined-only "$object" | grep -q step_with || { echo "no control step in $object" >&2; exit 1; }

case $processor in
  x86_64) double='\b(v?(add|sub|mul|div|sqrt|ucomi|comi)(sd|pd)|v?cvt[a-z0-9]*(sd|pd)[a-z0-9]*)\b' ;;
  aarch64) double='\bf(add|sub|mul|div|madd|cvt)\b.*\bd[0-9]' ;;
  *) exit 0 ;;
esac
if "$objdump" -d --no-show-raw-insn "$object" | grep -E "$double" >&2; then
  echo "the control core computes in double precision" >&2
  exit 1
fi
