#!/bin/sh
# Estimator and state feedback from a model, with the loop at 25 Hz: its gain on the position error.
set -eu
drive=${1:-/usr/share/axistool/drive}
parameters=$(mktemp)
trap 'rm -f "$parameters"' EXIT
axistool design "$drive/model.toml" -o "$parameters" --fc 25 --json - | sed -n '/"Kc"/{n;s/^ *\(.*\),/K1 = \1/p}'
