"""Identify feed drives, compare models with measurements, find the physical effect that a model lacks.

Each function asks the program `axistool` (of PATH, or the one that the environment variable AXISTOOL names), so that its
figures are those of the command line, bit for bit, and its errors say the same words. That is why this is not a binding
of the C++ library: a second way into it would have to parse, check, warn and refuse as the commands do; Ctrl-C and a
crash would reach into the interpreter; and the package would be built anew for every version of Python. A call costs
some 20 ms and a pass through files, against work that takes seconds.
"""

from .analysis import (
    Addition,
    Candidate,
    ChannelError,
    Comparison,
    Design,
    Diagnosis,
    Estimate,
    Fitted,
    Identification,
    Improvement,
    Rung,
    add,
    compare,
    design,
    diagnose,
    identify,
    improve,
    predict,
)
from .board import capture, disable, enable, set_parameters, simulated_board
from .errors import (
    AxisError,
    BadInput,
    DeviceFault,
    NoSuchDevice,
    NotPermitted,
    ProtocolError,
    Refused,
    TimeOut,
    UsageError,
)
from .model import Model
from .program import Progress
from .record import Record

__all__ = [
    "Addition",
    "AxisError",
    "BadInput",
    "Candidate",
    "ChannelError",
    "Comparison",
    "Design",
    "DeviceFault",
    "Diagnosis",
    "Estimate",
    "Fitted",
    "Identification",
    "Improvement",
    "Model",
    "NoSuchDevice",
    "NotPermitted",
    "Progress",
    "ProtocolError",
    "Record",
    "Refused",
    "Rung",
    "TimeOut",
    "UsageError",
    "add",
    "capture",
    "compare",
    "design",
    "diagnose",
    "disable",
    "enable",
    "identify",
    "improve",
    "predict",
    "set_parameters",
    "simulated_board",
]
