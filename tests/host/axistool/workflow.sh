#!/bin/bash
# workflow.sh AXISTOOL CASE FOLDER: from records to a board that follows their model, and whether it does, as the README
# tells it. AXIS_DEVICE names the board. Leaves jogs.csv and comparison.json in FOLDER.
set -euxo pipefail
axistool=$1
case=$2
cd "$3"
"$axistool" identify "$case/train-steps.csv" --drive "$case/model.toml" -o x.toml
"$axistool" friction "$case/train-jog.csv" --model x.toml -o x.toml
"$axistool" design x.toml -o x-params.toml
"$axistool" set-params x-params.toml host.timeout=5 --save # patient: a loaded computer must not look like a lost host
"$axistool" enable x --yes
"$axistool" jog x 20 --for 0.3
"$axistool" capture -o jogs.csv --jog 20:0.6,-20:0.6,60:0.4,-60:0.4
"$axistool" disable x
"$axistool" compare x.toml jogs.csv --json comparison.json
