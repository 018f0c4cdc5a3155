#!/bin/sh
# Runs cppcheck over our sources below $1 with $2 jobs. Tests are left to the compilers: cppcheck 2.10 does not know
# GoogleTest's macros.
set -eu
cd "$1"
exec cppcheck -j "$2" --std=c++20 --language=c++ --enable=warning,performance,portability --inline-suppr --quiet \
  --error-exitcode=1 --suppress=missingIncludeSystem -I . firmware hal host sim
