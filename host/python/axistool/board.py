"""Boards, simulated or real: their control loops, and records of their axes."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

from .errors import error_of
from .program import ModelLike, Progress, Workspace, end, program, run
from .record import Record


def _of(device: str | None) -> list[str]:
    return [] if device is None else ["--device", device]


@contextmanager
def simulated_board(x: ModelLike | None = None) -> Iterator[str]:
    """Runs a simulated board of one axis around a model (by default the paper's x axis) and gives what the other
    functions take as `device`. It keeps no parameters (set_parameters gives it some) and ends with the block."""
    with Workspace() as space:
        socket = space.path(".socket")
        arguments = [program(), "sim", "--forget", "--axes", "1", "--socket", str(socket)]
        arguments += [] if x is None else ["--x", space.model(x)]
        with subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
            assert child.stdout is not None and child.stderr is not None
            if not child.stdout.readline():  # it says where it listens, or nothing
                raise error_of(child.wait(), child.stderr.read())
            try:
                yield f"socket:{socket}"
            finally:
                end(child)


def set_parameters(parameters: str, axis: str = "x", device: str | None = None) -> None:
    """Gives an axis what a design made (`Design.parameters`): all of it, or nothing if one value is wrong."""
    with Workspace() as space:
        file = space.path(".toml")
        file.write_text(parameters, encoding="utf-8")
        run(["set-params", str(file), "--axis", axis, *_of(device)])


def enable(axis: str = "x", device: str | None = None) -> None:
    """Closes the control loop: the axis may move. The command line asks before; a call is the answer yes."""
    run(["enable", axis, "--yes", *_of(device)])


def disable(device: str | None = None) -> None:
    """Opens the control loops of all axes."""
    run(["disable", *_of(device)])


def capture(
    seconds: float,
    device: str | None = None,
    jog: str | None = None,
    axis: str = "x",
    progress: Progress | None = None,
) -> Record:
    """`device`: usb:SERIAL, sim or socket:PATH; the only one on USB by default. `jog`: "20:0.6,-20:0.6", mm/s and s, on an
    axis that is enabled."""
    with Workspace() as space:
        output = space.path(".csv")
        arguments = ["capture", "--axis", axis, "-o", str(output), "--for", repr(seconds), *_of(device)]
        run(arguments + ([] if jog is None else ["--jog", jog]), progress)
        return Record.read(output)
