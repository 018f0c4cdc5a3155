"""Exceptions for the exit codes of the program, with its messages."""

from __future__ import annotations


class AxisError(Exception):
    """A failure of the library. code: exit code of the program; the text is the program's message.

    >>> from axistool import compare
    >>> try:
    ...     compare("x.toml", "no-such.csv")
    ... except AxisError as failure:
    ...     print(failure.code)
    9
    """

    code = 0


class AnswerIsNo(AxisError):
    """The answer is no, for example because nothing is left to do.

    >>> AnswerIsNo("nothing is left to separate").code
    1
    """

    code = 1


class UsageError(AxisError):
    """An invalid argument.

    >>> from axistool import effects
    >>> try:
    ...     effects("coging")
    ... except UsageError as failure:
    ...     print(failure.code)
    2
    """

    code = 2


class NoSuchDevice(AxisError):
    """No board at this address.

    >>> from axistool import disable
    >>> try:
    ...     disable("socket:/no/such")
    ... except NoSuchDevice as failure:
    ...     print(failure.code)
    3
    """

    code = 3


class NotPermitted(AxisError):
    """The user may not open the board.

    >>> NotPermitted("/dev/hidraw0: permission denied").code
    4
    """

    code = 4


class ProtocolError(AxisError):
    """The board answers in another protocol or with a wrong checksum.

    >>> ProtocolError("another table of parameters").code
    5
    """

    code = 5


class DeviceFault(AxisError):
    """The board reports a fault; the text names its cause and remedy.

    >>> DeviceFault("following_error").code
    6
    """

    code = 6


class TimeOut(AxisError):
    """The board does not answer in time.

    >>> TimeOut("no answer within 1 s").code
    7
    """

    code = 7


class Refused(AxisError):
    """Refused for safety, or because the axis did not move enough.

    >>> from axistool import friction
    >>> try:
    ...     friction("steps.csv", "x.toml")  # steps hold no speed
    ... except Refused as failure:
    ...     print(failure.code)
    8
    """

    code = 8


class BadInput(AxisError):
    """A bad file or record; the text names file, line and remedy.

    >>> from axistool import Record
    >>> try:
    ...     Record.from_arrays(t_s=[0.0, 1.0], x_mm=[0.0]).write("short.csv")
    ... except BadInput as failure:
    ...     print(failure.code)
    9
    """

    code = 9


_KINDS: dict[int, type[AxisError]] = {kind.code: kind for kind in AxisError.__subclasses__()}


def error_of(code: int, text: str) -> AxisError:
    """The exception of an exit code."""
    return _KINDS.get(code, AxisError)(text)
