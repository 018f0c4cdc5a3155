#!/bin/bash
# workflow.sh AXISTOOL CASE FOLDER: the README's workflow: from records to a board with a controller, then compares its
# motion with the model. AXIS_DEVICE names the board. Writes jogs.csv and comparison.json to FOLDER.
set -euxo pipefail
axistool=$1
case=$2
cd "$3"
"$axistool" identify "$case/train-steps.csv" --drive "$case/model.toml" -o x.toml
"$axistool" friction "$case/train-jog.csv" --model x.toml -o x.toml
"$axistool" design x.toml -o x-params.toml
"$axistool" set-params x-params.toml host.timeout=5 --save # so that a loaded computer does not look like a lost host
"$axistool" enable x --yes
"$axistool" jog x 20 --for 0.3
"$axistool" capture -o jogs.csv --jog 20:0.6,-20:0.6,60:0.4,-60:0.4
"$axistool" disable x
"$axistool" compare x.toml jogs.csv --json comparison.json
