"""Records from a board, simulated or real."""

from __future__ import annotations

from .program import Workspace, run
from .record import Record


def capture(seconds: float, device: str | None = None, jog: str | None = None, axis: str = "x") -> Record:
    """`device`: usb:SERIAL, sim or socket:PATH; the only one on USB by default. `jog`: "20:0.6,-20:0.6", mm/s and s, on an
    axis that is enabled."""
    with Workspace() as space:
        output = space.path(".csv")
        arguments = ["capture", "--axis", axis, "-o", str(output), "--for", repr(seconds)]
        arguments += [] if device is None else ["--device", device]
        arguments += [] if jog is None else ["--jog", jog]
        run(arguments)
        return Record.read(output)
