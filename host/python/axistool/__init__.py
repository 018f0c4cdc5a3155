"""Identify feed drives, compare models with measurements, find the physical effect that a model lacks.

Each function calls the C++ library as the command of `axistool` of the same name does: figures are equal bit for bit, and
errors have the same words (`axistool open` is `open_logs`, `axistool import` is `Record.from_log`). They release Python's
lock while they compute, and Ctrl-C ends them.
"""

from .analysis import add, compare, design, diagnose, identify, improve, predict
from .board import capture, disable, enable, set_parameters, simulated_board
from .errors import (
    AnswerIsNo,
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
from .logs import Opening, cut, open_logs, sheet, shift
from .model import Model
from .record import Record
from .residuals import Residuals, residuals
from .results import (
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
    ImprovementStep,
)
from .sources import Progress
from .studies import (
    Circle,
    CircleCause,
    Export,
    Friction,
    Plan,
    Response,
    bode,
    circle,
    effects,
    export,
    friction,
    plan,
    scoreboard,
)

__all__ = [
    "Addition",
    "AnswerIsNo",
    "AxisError",
    "BadInput",
    "Candidate",
    "ChannelError",
    "Circle",
    "CircleCause",
    "Comparison",
    "Design",
    "DeviceFault",
    "Diagnosis",
    "Estimate",
    "Export",
    "Fitted",
    "Friction",
    "Identification",
    "Improvement",
    "ImprovementStep",
    "Model",
    "NoSuchDevice",
    "NotPermitted",
    "Opening",
    "Plan",
    "Progress",
    "ProtocolError",
    "Record",
    "Refused",
    "Residuals",
    "Response",
    "TimeOut",
    "UsageError",
    "add",
    "bode",
    "capture",
    "circle",
    "compare",
    "cut",
    "design",
    "diagnose",
    "disable",
    "effects",
    "enable",
    "export",
    "friction",
    "identify",
    "improve",
    "open_logs",
    "plan",
    "predict",
    "residuals",
    "scoreboard",
    "set_parameters",
    "sheet",
    "shift",
    "simulated_board",
]
