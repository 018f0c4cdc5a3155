#!/usr/bin/python3
"""Effects of which one shows in the torque and another only in the motion, on machines of a plant that shares nothing
with the simulator (tests/machines/made_machines.cpp): each is named, and nothing else."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

AXISTOOL, MADE_MACHINES = os.environ["AXISTOOL"], os.environ["MADE_MACHINES"]
# seed, effects hidden in each, and the case: a lag of the current loop beside backlash (its gap shows in the torque
# alone); friction of two kinds beside a tachometer's gain (which shows in the motion alone); a tachometer's offset beside
# friction that no motion tells from a constant torque; a gap with friction on either side beside friction's memory
CASES = ((7, 2, 2), (7, 3, 5), (601, 2, 1), (601, 2, 9))


def main() -> None:
    faults = []
    for seed, effects, number in CASES:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([MADE_MACHINES, str(seed), str(number + 1), str(effects), folder], check=True,
                           stdout=subprocess.DEVNULL)
            case = Path(folder) / f"case-{number:02d}"
            training = [case / f"train-{name}.csv" for name in ("jog", "steps", "sweep")]
            done = subprocess.run([AXISTOOL, "diagnose", case / "model.toml", "--train", *training, "--validate",
                                   case / "validate.csv", "--json", "-"], capture_output=True, text=True, check=False)
            verdict = json.loads(done.stdout)["verdict"]
            truth = json.loads((case / "truth.json").read_text())["effects"]
            groups = verdict["alternatives"]
            named = {next((frozenset(g) for g in groups if kind in g), frozenset([kind])) for kind in verdict["effects"]}
            named |= {frozenset(group) for group in groups}
            is_right = len(named) == len(truth) and all(any(kind in group for group in named) for kind in truth)
            print(f"{seed}, case {number}: {truth}: {verdict['status']} {verdict['effects']} {groups}")
            if not is_right:
                faults.append((seed, number))
    sys.exit(f"not right: {faults}" if faults else 0)


if __name__ == "__main__":
    main()
