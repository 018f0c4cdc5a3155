"""The library, as host/python/*.cpp bind it. A record is a path or columns and header, a model a path or (text,)."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

WINDOW_S: float

_Columns = dict[str, NDArray[np.float64]]
_Record = str | tuple[Mapping[str, NDArray[np.float64]], Mapping[str, str]]
_Model = str | tuple[str]
_Progress = Callable[[float, str], None] | None

def read_columns(path: str) -> tuple[_Columns, dict[str, str]]: ...
def import_record(
    path: str, map: str, resample_s: float | None, drive: str, unwrap: Sequence[str]
) -> tuple[_Columns, dict[str, str]]: ...
def checked(record: _Record) -> tuple[_Columns, dict[str, str]]: ...
def identify(records: Sequence[_Record], drive: _Model | None, method: str) -> tuple[str, str]: ...
def compare(model: _Model, records: Sequence[_Record], window_s: float) -> str: ...
def predict(model: _Model, record: _Record, window_s: float) -> tuple[_Columns, dict[str, str]]: ...
def diagnose(
    model: _Model,
    train: Sequence[_Record],
    validate: Sequence[_Record],
    hold: Sequence[str],
    prior: Sequence[str],
    absent: Sequence[str],
    progress: _Progress,
) -> str: ...
def add(
    model: _Model, kind: str, train: Sequence[_Record], validate: Sequence[_Record], over: str
) -> tuple[str, str]: ...
def improve(
    model: _Model,
    train: Sequence[_Record],
    validate: Sequence[_Record],
    hold: Sequence[str],
    prior: Sequence[str],
    absent: Sequence[str],
    progress: _Progress,
) -> tuple[str, str]: ...
def design(
    model: _Model,
    fc: float | None,
    zeta: float | None,
    rw: float | None,
    rwd: float | None,
    ru: float | None,
    rx: float | None,
    notch: Sequence[float],
    low_pass: Sequence[float],
) -> tuple[str, str]: ...

class Device:
    def __init__(self, words: str, patience_s: float) -> None: ...

class SimulatedBoard:
    def __init__(self, model: _Model | None, socket: str) -> None: ...
    def close(self) -> None: ...

def set_parameters(device: Device, text: str, axis: str) -> None: ...
def enable(device: Device, axis: str) -> None: ...
def disable(device: Device) -> None: ...
def capture(
    device: Device, axis: str, seconds: float, jogs: Sequence[str], progress: _Progress
) -> tuple[_Columns, dict[str, str]]: ...
