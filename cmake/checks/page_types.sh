#!/bin/sh
# Checks the types that the workbench's scripts below $1 state in their comments.
set -eu
cd "$1"
tsc --noEmit --allowJs --checkJs --target es2022 --module es2022 --moduleResolution node --lib es2022,dom,dom.iterable \
  host/workbench/page/main.js
