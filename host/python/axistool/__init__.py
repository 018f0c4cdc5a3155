"""Identify feed drives, compare models with measurements, find the physical effect that a model lacks.

The functions are the C++ library's own, those that the commands of `axistool` call: their figures are the command
line's, bit for bit, and their errors say the same words. They leave Python's lock while they compute, and end at Ctrl-C.
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
from .record import Record
from .residuals import Residuals, residuals
from .sources import Progress

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
    "Residuals",
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
    "residuals",
    "set_parameters",
    "simulated_board",
]
