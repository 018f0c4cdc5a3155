"""What goes wrong, by the exit code of the program and in its words."""

from __future__ import annotations


class AxisError(Exception):
    """The program ended with `code`; the text is what it said."""

    code = 0


class UsageError(AxisError):
    code = 2


class NoSuchDevice(AxisError):
    code = 3


class NotPermitted(AxisError):
    code = 4


class ProtocolError(AxisError):
    code = 5


class DeviceFault(AxisError):
    code = 6


class TimeOut(AxisError):
    code = 7


class Refused(AxisError):
    """For safety, or because the axis did not move enough."""

    code = 8


class BadInput(AxisError):
    code = 9


_KINDS: dict[int, type[AxisError]] = {
    kind.code: kind
    for kind in (UsageError, NoSuchDevice, NotPermitted, ProtocolError, DeviceFault, TimeOut, Refused, BadInput)
}


def error_of(code: int, said: str) -> AxisError:
    """The exception of an exit code, without the program's name before its words."""
    text = said.strip().removeprefix("axistool: ")
    return _KINDS.get(code, AxisError)(text or f"axistool ended with exit code {code}")
