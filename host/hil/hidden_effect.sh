#!/bin/sh
# Worked example: a circle on a machine with an effect that the model lacks. Finds the effect, compensates it and runs
# the circle again. Usage: hidden_effect.sh AXISTOOL FOLDER
set -eu
axistool=$1
folder=$2
scenarios=$(dirname "$0")/scenarios
mkdir -p "$folder"

contour() { # contour FILE.json: the largest contour error, um
  printf '%.1f' "$(sed -n 's/^ *"contour_um": *\([0-9.]*\).*/\1/p' "$1")"
}

echo "1. The circle with the controllers that the model gives, and a second record of the same machine"
for run in hidden-effect hidden-effect-check; do
  "$axistool" hil "$scenarios/$run.toml" -o "$folder" --json "$folder/$run.json" > "$folder/$run.txt"
done
before=$(contour "$folder/hidden-effect.json")
echo "   contour error $before um"

for axis in x y; do
  echo "2. Axis $axis: where the model fails, and what it lacks"
  "$axistool" compare "$folder/hidden-effect-$axis.toml" "$folder/hidden-effect-$axis.csv" \
    --report "$folder/compare-$axis.html" > "$folder/compare-$axis.txt" || [ $? -eq 1 ]
  "$axistool" diagnose "$folder/hidden-effect-$axis.toml" --train "$folder/hidden-effect-$axis.csv" \
    --validate "$folder/hidden-effect-check-$axis.csv" --report "$folder/diagnosis-$axis.html" \
    > "$folder/diagnosis-$axis.txt" || [ $? -eq 1 ]
  sed -n 1,2p "$folder/diagnosis-$axis.txt"
  "$axistool" improve "$folder/hidden-effect-$axis.toml" --train "$folder/hidden-effect-$axis.csv" \
    --validate "$folder/hidden-effect-check-$axis.csv" -o "$folder/better-$axis.toml" \
    > "$folder/improvement-$axis.txt"
  echo "3. Axis $axis: parameters of the board (axistool set-params $folder/better-$axis-params.toml)"
  "$axistool" design "$folder/better-$axis.toml" -o "$folder/better-$axis-params.toml" | grep compensate
done

echo "4. The same circle with the compensation that was found"
"$axistool" hil "$scenarios/hidden-effect.toml" --model "x=$folder/better-x.toml" --model "y=$folder/better-y.toml" \
  --before-after -o "$folder/after" --json "$folder/after.json" > "$folder/after.txt"
sed -n 's/^Before and after: /   /p' "$folder/after.txt"
page=$folder/after/hidden-effect.html
echo "   before and after on one page: $page"
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && command -v xdg-open > /dev/null; then
  xdg-open "$page" > /dev/null 2>&1 &
fi
