#!/usr/bin/python3
"""Machines with a scale on the table that are unknown to the program (table_machine.py). Each has up to three of
backlash, compliance, pitch error, cyclic errors of scale and motor encoder, and thermal growth, or none. Seeds are
printed. The argument is the number of machines to try; each is diagnosed with and without its scale. Without the
argument, two machines are tried. One of them has a gap and a spring, and other pairs of gap and spring have the same
lost motion. One more is diagnosed without a scale: its spring, which the friction of one side deflects, looks like a gap.
AXIS_ALL_MACHINES=1 (make test-machines) adds two: the torque of one alone indicates a gap, but the motion excludes it; the
other has a rigid gap that looks like a spring in the torque."""

import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from table_machine import LEAD, Machine  # noqa: E402

AXISTOOL = os.environ["AXISTOOL"]
FEW = (1, 438)
WITHOUT_SCALE = (105, 425, 581) if os.environ.get("AXIS_ALL_MACHINES") else (425,)


def axistool(*arguments: object) -> dict:
    """The JSON output of the program; fails if the program reports an error."""
    done = subprocess.run([AXISTOOL, *map(str, arguments), "--json", "-"], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        raise AssertionError(f"axistool {' '.join(map(str, arguments))}: exit {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


def names_in(table: dict) -> "set[str]":
    """The effects found, by the names of the machine, without those that are too small to be named."""
    found = set()
    for effect in table["found"]:
        if not effect["worth_naming"]:
            continue
        kind = effect["kinds"][0]
        if len(effect["kinds"]) > 1:
            found.add(" or ".join(effect["kinds"]))
        elif kind == "encoder_cyclic_error":
            found.add(f"{kind} {'motor' if effect['place'] == 'motor' else 'scale'}")
        else:
            found.add(kind)
    return found


def faults_of_sizes(machine: Machine, table: dict) -> "list[str]":
    faults = []
    for effect in table["found"]:
        sizes = effect["sizes"]
        if effect["kinds"] == ["backlash"] and "backlash" in machine.causes:
            off = abs(sizes["gap"]["value"] - 1e3 * machine.gap)
            if off > max(2.0, 0.05 * 1e3 * machine.gap):
                faults.append(f"gap {sizes['gap']['value']:.2f} um instead of {1e3 * machine.gap:.2f}")
        if effect["kinds"] == ["pitch_error"] and "pitch_error" in machine.causes:
            true = [1e3 * machine.pitch(point["x_mm"]) for point in effect["curve"]]
            mean = sum(true) / len(true)
            off = max(abs(point["um"] - value + mean) for point, value in zip(effect["curve"], true))
            if off > 1.0:
                faults.append(f"pitch error off by {off:.2f} um")
        if effect["kinds"] == ["compliance"] and "compliance" in machine.causes:
            true_um = 1e3 / machine.stiffness / (1e-3 * LEAD)  # per Nm
            print(f"    compliance {sizes['compliance']['value']:.3f}, true {true_um:.3f} um/Nm")
    return faults


def write_records(machine: Machine, path: Path) -> Path:
    """Its data sheet, two records with and without the scale, and the model identified from them."""
    (path / "sheet.toml").write_text(machine.sheet())
    for name, seconds, run in (("train", 20.0, 1), ("judge", 14.0, 2)):
        text = machine.record(seconds, run)
        (path / f"{name}.csv").write_text(text)
        head, columns, *rows = text.split("t_s,", 1)[0], "t_s,i_A,x_mm", *text.splitlines()[4:]
        (path / f"{name}-motor.csv").write_text(
            head + columns + "\n" + "\n".join(row.rsplit(",", 1)[0] for row in rows) + "\n")
    model = path / "x.toml"
    axistool("identify", path / "train.csv", "--drive", path / "sheet.toml", "-o", model)
    return model


def main() -> None:
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    seeds = range(first, first + int(sys.argv[1])) if len(sys.argv) > 1 else FEW
    right, wrong_names, sizes_off = 0, 0, 0
    for seed in seeds:
        machine = Machine(seed)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder)
            model = write_records(machine, path)
            table = axistool("compare", model, path / "train.csv", path / "judge.csv")["table"]
            found, faults = names_in(table), faults_of_sizes(machine, table)
            is_right = found == machine.causes
            right += is_right
            sizes_off += bool(faults)
            print(f"seed {seed}: {sorted(machine.causes)} {'right' if is_right else f'NOT {sorted(found)}'} "
                  f"{'; '.join(faults)}")
            if len(sys.argv) > 1:
                wrong_names += diagnosed(machine, model, path)
    for seed in WITHOUT_SCALE if len(sys.argv) == 1 else ():
        machine = Machine(seed)
        with tempfile.TemporaryDirectory() as folder:
            wrong_names += diagnosed(machine, write_records(machine, Path(folder)), Path(folder), WITHOUT)
    print(f"{right} of {len(seeds)} right, {sizes_off} sizes off, {wrong_names} wrong names by diagnose")
    assert right >= math.ceil(0.95 * len(seeds)) and sizes_off == 0 and wrong_names == 0


WITHOUT = (("without", "-motor"),)


def diagnosed(machine: Machine, model: Path, path: Path, ways: "tuple" = (("with the scale", ""), *WITHOUT)) -> int:
    """Names that diagnose gives with and without the scale; counts the effects that the machine does not have."""
    true = {cause.split()[0] for cause in machine.causes}
    wrong = 0
    for how, ending in ways:
        verdict = axistool("diagnose", model, "--train", path / f"train{ending}.csv", "--validate",
                           path / f"judge{ending}.csv")["verdict"]
        is_wrong = verdict["status"] == "missing" and not set(verdict["effects"]) <= true
        wrong += is_wrong
        print(f"    {how}: {verdict['status']} {verdict['effects']}{' WRONG' if is_wrong else ''}")
    return wrong


if __name__ == "__main__":
    main()
