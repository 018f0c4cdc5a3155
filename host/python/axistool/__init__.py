"""Identify feed drives, compare models with measurements, find the physical effect that a model lacks.

Each function asks the program `axistool` (of PATH, or the one that the environment variable AXISTOOL names), so that its
figures are those of the command line, bit for bit, and its errors say the same words.
"""

from .analysis import (
    Candidate,
    ChannelError,
    Comparison,
    Design,
    Diagnosis,
    Estimate,
    Identification,
    Improvement,
    Rung,
    compare,
    design,
    diagnose,
    identify,
    improve,
    predict,
)
from .board import capture
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

__all__ = [
    "AxisError",
    "BadInput",
    "Candidate",
    "ChannelError",
    "Comparison",
    "Design",
    "DeviceFault",
    "Diagnosis",
    "Estimate",
    "Identification",
    "Improvement",
    "Model",
    "NoSuchDevice",
    "NotPermitted",
    "ProtocolError",
    "Record",
    "Refused",
    "Rung",
    "TimeOut",
    "UsageError",
    "capture",
    "compare",
    "design",
    "diagnose",
    "identify",
    "improve",
    "predict",
]
