#!/bin/sh
# Error over noise floor on a held-back record: about 1 for a perfect model.
set -eu
drive=${1:-/usr/share/axistool/drive}
axistool compare "$drive/model.toml" "$drive/validate.csv" ${2:+--report "$2/02-compare.html"} --json - | sed -n 's/^  "combined": \(.*\),/error over floor = \1/p'
