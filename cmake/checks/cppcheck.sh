#!/bin/sh
# Runs cppcheck over our sources below $1 with $2 jobs. Tests are left to the compilers: cppcheck 2.10 does not know
# GoogleTest's macros. It does not know strings as template arguments either; they are removed from the copy that it
# reads.
set -eu
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
cd "$1"
cp -r firmware hal host sim "$copy"
cd "$copy"
find . -name '*.[ch]pp' -exec sed -i 's/<"[^"<>]*">//g' {} +
cppcheck -j "$2" --std=c++20 --language=c++ --enable=warning,performance,portability --inline-suppr --quiet \
  --error-exitcode=1 --suppress=missingIncludeSystem -I . firmware hal host sim
