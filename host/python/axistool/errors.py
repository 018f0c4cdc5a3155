"""What goes wrong, by the exit code that the program would end with, and in its words."""

from __future__ import annotations


class AxisError(Exception):
    """`code` is the program's exit code of such a failure; the text is what it would say."""

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


def error_of(code: int, text: str) -> AxisError:
    """The exception of an exit code."""
    return _KINDS.get(code, AxisError)(text)
