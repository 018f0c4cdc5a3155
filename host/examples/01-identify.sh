#!/bin/sh
# Inertia from a record of steps.
set -eu
drive=${1:-/usr/share/axistool/drive}
model=$(mktemp)
trap 'rm -f "$model"' EXIT
axistool identify "$drive/train-steps.csv" --drive "$drive/model.toml" -o "$model" --json - |
  sed -n '/"J_kg_m2"/,/}/s/.*"value": /J = /p'
