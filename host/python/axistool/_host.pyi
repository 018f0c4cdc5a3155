"""The bindings of host/python/*.cpp. A record is a path, or columns and header; a model is a path or (text,)."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

WINDOW_S: float
MOST_STEPS: float

_Columns = dict[str, NDArray[np.float64]]
_Record = str | tuple[Mapping[str, NDArray[np.float64]], Mapping[str, str]]
_Model = str | tuple[str]
_Progress = Callable[[float, str], None] | None

def read_columns(path: str) -> tuple[_Columns, dict[str, str]]: ...
def import_record(
    path: str, map: str, resample_s: float | None, drive: str, unwrap: Sequence[str]
) -> tuple[_Columns, dict[str, str]]: ...
def checked(record: _Record) -> tuple[_Columns, dict[str, str]]: ...
def identify(
    records: Sequence[_Record],
    drive: _Model | None,
    method: str,
    report: str,
    gain: str,
    loaded: Sequence[_Record],
    added_mass: float | None,
    added_inertia: float | None,
    purpose: str,
    window_s: float | None,
) -> tuple[str, str]: ...
def compare(model: _Model, records: Sequence[_Record], window_s: float, report: str) -> str: ...
def predict(model: _Model, record: _Record, window_s: float) -> tuple[_Columns, dict[str, str]]: ...
def diagnose(
    model: _Model,
    train: Sequence[_Record],
    validate: Sequence[_Record],
    hold: Sequence[str],
    prior: Sequence[str],
    absent: Sequence[str],
    believed: str,
    report: str,
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
    output: str,
    report: str,
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
    limits: str,
    reserve: float,
    velocity: float | None,
) -> tuple[str, str]: ...

def open_logs(
    logs: Sequence[str],
    sheet: _Model | None,
    map: str,
    hal: str,
    drive: str,
    torque_constant: float | None,
    period_s: float | None,
) -> tuple[str, list[tuple[str, str, tuple[_Columns, dict[str, str]]]], str]: ...
def sheet(
    name: str,
    is_rotary: bool,
    by_current: bool,
    motor_constant: float | None,
    lead_mm: float | None,
    step_mm: float | None,
    period_s: float | None,
) -> str: ...
def cut(path: str, text: str, from_s: float, to_s: float) -> tuple[_Columns, dict[str, str]]: ...
def shift(record: _Record, channel: str, by_s: float) -> tuple[_Columns, dict[str, str]]: ...
def friction(
    records: Sequence[_Record], model: _Model, method: str, settle_s: float, shortest_s: float
) -> tuple[str, str]: ...
def plan(
    model: _Model,
    train: Sequence[_Record],
    validate: Sequence[_Record],
    rivals: Sequence[Sequence[str]],
    box: str,
    most_steps: float,
    output: str,
    report: str,
    progress: _Progress,
) -> tuple[str, str]: ...
def bode(records: Sequence[_Record], model: _Model | None, parameters: str, report: str) -> tuple[str, str]: ...
def circle(records: Sequence[_Record], models: Sequence[_Model], report: str) -> str: ...
def export_model(
    model: _Model, to: str, path: str, record: _Record | None
) -> tuple[str, list[tuple[str, str]]]: ...
def effects(kind: str) -> str: ...
def scoreboard(folder: str, cuts: bool, sample: int, seed: int, nulls: int, progress: _Progress) -> str: ...

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
