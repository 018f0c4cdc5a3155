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
    """The device as for the command line: AXIS_DEVICE, else the only board on USB; time-out AXIS_PATIENCE, else 1 s."""
    words = os.environ.get("AXIS_DEVICE", "") if device is None else device
    return _host.Device(words, float(os.environ.get("AXIS_PATIENCE", "1")))


@contextmanager
def simulated_board(x: ModelLike | None = None) -> Iterator[str]:
    """A simulated board with one axis, for the duration of the block. Yields its name, for `device` of the other
    functions and of the command line. It runs in real time in a separate thread.

    x: the model to simulate; by default the paper's x axis. The board starts without parameters: use set_parameters.
    Raises BadInput for a bad model.

    >>> from axistool import design
    >>> with simulated_board("x.toml") as device:
    ...     set_parameters(design("x.toml").parameters, device=device)
    ...     enable(device=device)
    ...     record = capture(0.2, device)  # s
    ...     disable(device)
    >>> len(record) >= 200, record["x_mm"].shape == (len(record),)
    (True, True)
    """
    with tempfile.TemporaryDirectory(prefix="axistool-") as folder:
        socket = Path(folder) / "board.socket"
        board = _host.SimulatedBoard(None if x is None else model_source(x), str(socket))
        try:
            yield f"socket:{socket}"
        finally:
            board.close()


def set_parameters(parameters: str, axis: str = "x", device: str | None = None) -> None:
    """Sets the parameters of an axis (text, as `Design.parameters`): all of them, or none if one is wrong.

    device: usb:SERIAL, sim or socket:PATH; by default AXIS_DEVICE, else the only board on USB. Raises BadInput for a
    wrong value, NoSuchDevice, ProtocolError or TimeOut for the board.

    >>> with simulated_board("x.toml") as device:
    ...     set_parameters("x.loop.unknown = 1.0", device=device)
    Traceback (most recent call last):
    ...
    axistool.errors.BadInput: ...
    """
    _host.set_parameters(_device(device), parameters, axis)


def enable(axis: str = "x", device: str | None = None) -> None:
    """Closes the control loop of an axis, which may then move. Unlike the command line it does not ask.

    Raises DeviceFault if a fault prevents it, Refused for an axis without parameters.

    >>> with simulated_board("x.toml") as device:
    ...     enable("x", device)
    Traceback (most recent call last):
    ...
    axistool.errors.Refused: ...
    """
    _host.enable(_device(device), axis)


def disable(device: str | None = None) -> None:
    """Slows all axes down and opens their control loops.

    >>> with simulated_board("x.toml") as device:
    ...     disable(device)
    """
    _host.disable(_device(device))


def capture(
    seconds: float,
    device: str | None = None,
    jog: str | None = None,
    axis: str = "x",
    progress: Progress | None = None,
) -> Record:
    """A record of an axis at loop rate: t_s (s), u_V (V), x_mm (mm) and the others of `axistool capture`, each (n,).

    seconds: 0 to 86400; 0: the duration of the jogs. jog: jogs of an enabled axis, "20:0.6,-20:0.6" in mm/s and s; the
    axis stops when the capture ends for any reason. device: as for set_parameters. Raises UsageError for a wrong
    duration, Refused for a jog of an axis that is not enabled, NoSuchDevice, ProtocolError or TimeOut for the board.

    >>> with simulated_board("x.toml") as device:
    ...     record = capture(0.1, device)
    >>> len(record) >= 100, bool((record["t_s"][1:] > record["t_s"][:-1]).all())
    (True, True)
    """
    jogs = [] if jog is None else jog.split(",")
    columns, header = _host.capture(_device(device), axis, seconds, jogs, progress)
    return Record(columns, header)
