"""Boards, simulated or real: their control loops, and records of their axes."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from . import _host
from .record import Record
from .sources import ModelLike, Progress, model_source


def _device(device: str | None) -> _host.Device:
    """As the command line finds it: AXIS_DEVICE, else the only board on USB; AXIS_PATIENCE, else a second."""
    words = os.environ.get("AXIS_DEVICE", "") if device is None else device
    return _host.Device(words, float(os.environ.get("AXIS_PATIENCE", "1")))


@contextmanager
def simulated_board(x: ModelLike | None = None) -> Iterator[str]:
    """Runs a simulated board of one axis around a model (by default the paper's x axis), in real time in a thread of its
    own, and gives what the other functions take as `device`; so does the command line. It keeps no parameters
    (set_parameters gives it some) and ends with the block."""
    with tempfile.TemporaryDirectory(prefix="axistool-") as folder:
        socket = Path(folder) / "board.socket"
        board = _host.SimulatedBoard(None if x is None else model_source(x), str(socket))
        try:
            yield f"socket:{socket}"
        finally:
            board.close()


def set_parameters(parameters: str, axis: str = "x", device: str | None = None) -> None:
    """Gives an axis what a design made (`Design.parameters`): all of it, or nothing if one value is wrong."""
    _host.set_parameters(_device(device), parameters, axis)


def enable(axis: str = "x", device: str | None = None) -> None:
    """Closes the control loop: the axis may move. The command line asks before; a call is the answer yes."""
    _host.enable(_device(device), axis)


def disable(device: str | None = None) -> None:
    """Opens the control loops of all axes."""
    _host.disable(_device(device))


def capture(
    seconds: float,
    device: str | None = None,
    jog: str | None = None,
    axis: str = "x",
    progress: Progress | None = None,
) -> Record:
    """`device`: usb:SERIAL, sim or socket:PATH; the only one on USB by default. `jog`: "20:0.6,-20:0.6", mm/s and s, on an
    axis that is enabled; it stops whatever ends the capture."""
    jogs = [] if jog is None else jog.split(",")
    columns, header = _host.capture(_device(device), axis, seconds, jogs, progress)
    return Record(columns, header)
