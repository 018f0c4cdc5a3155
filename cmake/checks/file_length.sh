#!/bin/sh
# Fails when a source file of the tree $1 is longer than 500 lines.
set -eu
limit=500
cd "$1"
find firmware hal host sim tests cmake Makefile -type f \
  \( -name '*.[ch]pp' -o -name '*.[chS]' -o -name '*.sh' -o -name '*.js' -o -name '*.css' -o -name '*.cmake' \
  -o -name CMakeLists.txt -o -name Makefile \) -exec awk -v limit="$limit" '
    FNR == limit + 1 { print FILENAME ": longer than " limit " lines; split it by concept"; found = 1 }
    END { exit found }' {} +
