"""identify, compare, predict, diagnose, add, improve, design: the analyses of the commands with the same names.

`report`: HTML file to write, with the page of the command's --report.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from . import _host
from .errors import UsageError
from .model import Model
from .record import Record
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
from .sources import (
    ModelLike,
    PathLike,
    Progress,
    RecordLike,
    Records,
    model_source,
    path_text,
    record_source,
    record_sources,
)


def identify(
    records: Records,
    drive: ModelLike | None = None,
    method: str | None = None,
    *,
    report: PathLike | None = None,
    gain: str = "sheet",
    loaded: Records | None = None,
    added_mass: float | None = None,
    added_inertia: float | None = None,
    purpose: str = "control",
    window_s: float | None = None,
) -> Identification:
    """Inertia (or mass), viscous and Coulomb friction, with 95 % intervals.

    records: one or several of the same drive, with t_s (s), a command u_V (V) or current i_A (A), and a position (x_mm,
    x_m) or speed (w_rad_s, v_m_s). drive: the data sheet; by default the paper's drive if the record names it. method:
    "sliding-ls", "unbiased-ls" or "ls"; by default the first with a tachometer, else the second. Raises Refused if the
    axis hardly moves, BadInput for a bad file, UsageError for an unknown method. gain: source of the torque per
    command: "sheet" (data sheet), "current" (from u_V and i_A of the records), or "inertia" (from `loaded`, records of
    the same drive with added_mass in kg on the table, or added_inertia in kg m^2 at the motor; linear drive: kg).
    purpose: "control" (least error of the torque or force) or "prediction" (of the motion predicted over window_s; by
    default 0.1 s).

    >>> found = identify("steps.csv", drive="drive.toml", report="identify.html")
    >>> low, high = found.parameters["J_kg_m2"].ci95  # kg m^2
    >>> low < found.parameters["J_kg_m2"].value < high
    True
    """
    sheet = None if drive is None else model_source(drive)
    if purpose not in ("control", "prediction"):
        raise UsageError('purpose is "control" or "prediction"')
    if (loaded is not None) != ((added_mass is None) != (added_inertia is None)):
        raise UsageError("loaded needs either added_mass or added_inertia, and they need loaded")
    text, model = _host.identify(record_sources(records), sheet, method or "", path_text(report), gain,
                                 record_sources(loaded), added_mass, added_inertia, purpose, window_s)
    answer = json.loads(text)
    parameters = {name: Estimate(one["value"], (one["ci95"][0], one["ci95"][1]))
                  for name, one in answer["parameters"].items()}
    return Identification(Model.parse(model), parameters, answer["relative_error"], answer["warnings"], answer)


def compare(
    model: ModelLike, records: Records, window_s: float | None = None, *, report: PathLike | None = None
) -> Comparison:
    """How well a model predicts records from their recorded command alone.

    window_s: length of a prediction, s, above 0; each restarts from the smoothed measured state. Raises BadInput for a
    record that does not fit the model.

    >>> compared = compare("x.toml", "jog.csv", report="compare.html")
    >>> compared.channels["x_mm"].rms > compared.channels["x_mm"].floor > 0.0  # mm
    True
    """
    window_s = _host.WINDOW_S if window_s is None else window_s
    answer = json.loads(_host.compare(model_source(model), record_sources(records), window_s, path_text(report)))
    channels = {name: ChannelError(one["rms"], one["floor"], one["fit"]) for name, one in answer["channels"].items()}
    return Comparison(answer["combined"], channels, answer["relative_error"], answer)


def predict(model: ModelLike, record: RecordLike, window_s: float | None = None) -> Record:
    """A record of n rows with measured and predicted position and speed, each of shape (n,).

    The predicted columns are x_pred_mm (mm) and w_pred_rad_s (rad/s); of a linear drive x_pred_m (m) and v_pred_m_s
    (m/s). window_s: as for compare. Raises BadInput for a record that does not fit the model.

    >>> rows = predict("x.toml", "jog.csv")
    >>> rows["x_pred_mm"].shape == rows["x_mm"].shape
    True
    """
    window_s = _host.WINDOW_S if window_s is None else window_s
    columns, header = _host.predict(model_source(model), record_source(record), window_s)
    return Record(columns, header)


def _beliefs(prior: Mapping[str, float]) -> list[str]:
    return [f"{name}={float(deviation)!r}" for name, deviation in prior.items()]


def diagnose(
    model: ModelLike,
    train: Records,
    validate: Records | None = None,
    *,
    hold: Iterable[str] = (),
    prior: Mapping[str, float] = MappingProxyType({}),
    absent: Iterable[str] = (),
    believed: PathLike | None = None,
    report: PathLike | None = None,
    progress: Progress | None = None,
) -> Diagnosis:
    """Which physical effect the model lacks.

    train, validate: records; without `validate`, blocks of the training data are held back. hold: parameters that keep
    the model's value ("J_kg_m2"). prior: standard deviations of the model's values, in their units. absent: effects
    that this machine certainly does not have. believed: prior odds, a JSON file that plan or diagnose wrote before the
    planned run in `train`. Raises BadInput for a bad file, UsageError for an unknown parameter or effect.

    >>> found = diagnose("y.toml", "y-jog.csv", "y-valid.csv", report="diagnose.html")
    >>> found.status
    'adequate'
    """
    answer = json.loads(_host.diagnose(model_source(model), record_sources(train), record_sources(validate), list(hold),
                                       _beliefs(prior), list(absent), path_text(believed), path_text(report), progress))
    verdict = answer["verdict"]
    candidates = [Candidate(one["kinds"], one["before"], one["after"], one["confidence"], one["parameters"])
                  for one in answer["candidates"]]
    return Diagnosis(verdict["status"], verdict["effects"], verdict["explanation"], verdict["next_experiment"],
                     candidates, answer)


def add(
    model: ModelLike, kind: str, train: Records, validate: Records | None = None, *, over: str | None = None
) -> Addition:
    """Adds one effect to the model and fits all parameters again.

    kind: a kind of `effects()`. over: coordinate of a free_curve; by default the one with the smallest validation
    error. If the effect increases the validation error, the result contains the unchanged model. Raises UsageError for
    an effect that is unknown or cannot be added, Refused if no part of the records shows it.

    >>> added = add("z.toml", "cogging", "z-jog.csv")
    >>> added.after < 0.5 * added.before, "cogging" in added.model.kinds
    (True, True)
    """
    text, new = _host.add(model_source(model), kind, record_sources(train), record_sources(validate), over or "")
    answer = json.loads(text)
    parameters = {one["name"]: Fitted(one["value"], one["deviation"], one["determined"])
                  for one in answer["parameters"]}
    return Addition(Model.parse(new), answer["before"], answer["after"], answer["confidence"], parameters, answer)


def improve(
    model: ModelLike,
    train: Records,
    validate: Records | None = None,
    *,
    hold: Iterable[str] = (),
    prior: Mapping[str, float] = MappingProxyType({}),
    absent: Iterable[str] = (),
    output: PathLike | None = None,
    report: PathLike | None = None,
    progress: Progress | None = None,
) -> Improvement:
    """Adds effects while each is significant on validation data.

    The arguments are those of diagnose. output: file to write the better model to; a report names it. Raises as
    diagnose does, and UsageError for a report without an output.

    >>> better = improve("y.toml", "y-jog.csv", "y-valid.csv", output="better.toml", report="improve.html")
    >>> better.ladder[-1].validate < 1.2  # times the noise floor
    True
    """
    require_output(output, report)
    text, better = _host.improve(model_source(model), record_sources(train), record_sources(validate), list(hold),
                                 _beliefs(prior), list(absent), path_text(output), path_text(report), progress)
    answer = json.loads(text)
    ladder = [ImprovementStep(one["added"], one["train"], one["validate"]) for one in answer["ladder"]]
    return Improvement(Model.parse(better), ladder, answer["stopped_because"], answer)


def design(
    model: ModelLike,
    *,
    fc: float | None = None,
    zeta: float | None = None,
    rw: float | None = None,
    rwd: float | None = None,
    ru: float | None = None,
    rx: float | None = None,
    notch: float | Sequence[float] = (),
    low_pass: float | Sequence[float] = (),
    limits: str = "usual",
    reserve: float = 0.3,
    velocity: float | None = None,
) -> Design:
    """Kalman gain and state feedback.

    fc (Hz), zeta: natural frequency and damping of the closed loop. rw, rwd, ru, rx: variances of tachometer
    ((rad/s)^2), disturbance (V^2), command (V^2) and position (mm^2). notch, low_pass: frequency in Hz, optionally
    followed by damping and, for the notch, depth. limits: limits of references, "usual" or "drive" (the most that the
    drive allows with `reserve`, a share of its torque or force); velocity: top speed of screw and guides, mm/s. Raises
    BadInput for an implausible model or design, Refused if friction leaves nothing for acceleration, UsageError for
    other limits.

    >>> design("x.toml", fc=25.0, notch=[110.0, 0.5]).Kc.shape
    (2,)
    """
    if limits not in ("usual", "drive") or not 0.0 <= reserve <= 0.9:
        raise UsageError('limits is "usual" or "drive", reserve 0 to 0.9')
    text, parameters = _host.design(model_source(model), fc, zeta, rw, rwd, ru, rx, _numbers(notch),
                                    _numbers(low_pass), limits, reserve, velocity)
    answer = json.loads(text)
    poles = np.array([complex(re, im) for re, im in answer["observer_poles"]])
    return Design(np.array(answer["A"]), np.array(answer["B"]), np.array(answer["Kobs"]), np.array(answer["Kc"]), poles,
                  parameters, answer)


def require_output(output: PathLike | None, report: PathLike | None) -> None:
    """Raises UsageError for a report without an output file of the result."""
    if report is not None and output is None:
        raise UsageError("a report needs output=, because it states the name of the result's file")


def _numbers(given: float | Sequence[float]) -> list[float]:
    return list(given) if isinstance(given, Sequence) else [given]
