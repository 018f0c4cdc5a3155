#!/bin/sh
# image_symbols.sh NM SIZE FLASH_LIMIT RAM_LIMIT IMAGE.elf...
# Fails when an image contains functions that must not be on the target (heap, double precision, exceptions) or is too
# large.
set -eu
nm=$1 size=$2 flash_limit=$3 ram_limit=$4
shift 4
status=0
for image in "$@"; do
  found=$("$nm" "$image" | awk '{ print $NF }' |
    grep -E '^(_?malloc|_?free|_?calloc|_?realloc|_malloc_r|_sbrk|__aeabi_(d[a-z0-9]+|f2d|i2d|ui2d|l2d|ul2d)|__cxa_.*|_Unwind.*|_Znw.*|_Zdl.*)$' || true)
  if [ -n "$found" ]; then
    echo "$image holds what must not be on the target:" $found >&2
    status=1
  fi
  capture=$("$nm" "$image" | awk '$3 == "_capture_rows" || $3 == "_capture_end" { print "0x" $1 }' | sort | xargs)
  # An image without a capture has neither symbol.
  [ -z "$capture" ] || capture=$((${capture#* } - ${capture% *}))
  "$size" -A "$image" | awk -v image="$image" -v capture="${capture:-0}" -v flash_limit="$flash_limit" -v ram_limit="$ram_limit" '
    $1 ~ /^\.(vectors|image_header|text|ARM\.exidx|data|ccm)$/ { flash += $2 }
    $1 ~ /^\.(stack|noinit|data|bss|ccm)$/ { ram += $2 }
    END {
      n = split(image, parts, "/")
      printf "%-28s flash %6d of %d bytes, RAM %6d of %d bytes, capture memory %6d bytes\n", parts[n], flash, flash_limit, ram, ram_limit, capture
      if (flash == 0 || flash > flash_limit || ram > ram_limit) { print image ": too large" > "/dev/stderr"; exit 1 }
    }' || status=1
done
exit $status
