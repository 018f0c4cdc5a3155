#!/usr/bin/env python3
"""Commissions two axes of one board one after the other; compares the contour error of a circle before and after.

contour.py AXISTOOL MACHINES.json [--keep FOLDER]

Before: each axis is homed and has the first controller of its commissioning. The board is simulated in real time and
used over its protocol; this takes a quarter of an hour. Fails unless the contour error falls by more than 10 %.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import bench

CIRCLE = "G21 G90\nG0 X0 Y0\nG1 X10 Y0 F600\nG2 X10 Y0 I-10 J0 F1200\nG2 X10 Y0 I-10 J0\nG1 X0 Y0\nM2\n"
AXES = {"x": "01-cogging", "y": "18-cogging-and-weight"}  # of the second machine only the cogging: a level axis


def write_machines(book, folder):
    for axis, name in AXES.items():
        entry = next(e for e in book["machines"] if e["name"] == name)
        base = {**book["bases"][entry["base"]], **entry.get("base_changes", {})}
        hidden = [e for e in entry["hides"] if e["kind"] == "cogging"]
        (folder / f"{axis}-truth.toml").write_text(bench.machine(base, hidden))
        (folder / f"{axis}-sheet.toml").write_text(bench.data_sheet(base, entry["sheet"]["torque"]))
    (folder / "circle.ngc").write_text(CIRCLE)
    return book["bases"]["screw"]["box"]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("axistool")
    parser.add_argument("machines")
    parser.add_argument("--keep")
    options = parser.parse_args()
    axistool = str(pathlib.Path(options.axistool).resolve())
    folder = pathlib.Path(options.keep or tempfile.mkdtemp(prefix="commission-contour-"))
    folder.mkdir(parents=True, exist_ok=True)
    box = write_machines(json.loads(pathlib.Path(options.machines).read_text()), folder)
    socket = folder / "board.socket"
    environment = {**os.environ, "AXIS_DEVICE": f"socket:{socket}", "AXIS_PATIENCE": "10"}

    def tool(*arguments):
        subprocess.run([axistool, *arguments], cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)

    def circle(name):
        tool("enable", "x", "y", "--yes")
        for axis in AXES:
            tool("home", axis, "--yes")
        tool("run", "circle.ngc", "--yes", "--capture", f"{name}.csv", "--json", f"{name}.json")
        tool("disable", "x", "y")
        return json.loads((folder / f"{name}.json").read_text())

    board = subprocess.Popen([axistool, "sim", "--x", "x-truth.toml", "--y", "y-truth.toml", "--socket", str(socket), "--forget"],
                             cwd=folder, stdout=subprocess.DEVNULL)
    try:
        while not socket.exists() and board.poll() is None:
            time.sleep(0.1)
        for axis in AXES:
            tool("commission", axis, "--drive", f"{axis}-sheet.toml", "-o", axis, "--box", box, "--home", "both", "--yes", "--to", "home")
        before = circle("before")
        for axis in AXES:
            tool("commission", axis, "-o", axis, "--home", "both", "--yes", "--from", "ladder")
        after = circle("after")
    finally:
        board.terminate()
        board.wait()
    for name, run in (("before", before), ("after", after)):
        print(f"{name:<7} contour error {run['contour_um']:.2f} µm at most, {run['contour_rms_um']:.2f} µm RMS")
    return 0 if after["contour_rms_um"] < 0.9 * before["contour_rms_um"] else 1


if __name__ == "__main__":
    sys.exit(main())
