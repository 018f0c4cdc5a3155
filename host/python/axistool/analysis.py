"""identify, compare, diagnose, add, improve, design. `json` of every result is the whole answer, the
document that the command prints with --json."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _host
from .model import Model
from .record import Record
from .sources import ModelLike, Progress, RecordLike, Records, model_source, record_source, record_sources
from .tables import html_table


@dataclass(frozen=True)
class Estimate:
    value: float
    ci95: tuple[float, float]


@dataclass(frozen=True)
class Identification:
    model: Model
    parameters: Mapping[str, Estimate]
    relative_error: float  # norm(residual) / norm(torque or force)
    warnings: Sequence[str]
    json: Mapping[str, Any]

    def _repr_html_(self) -> str:
        rows = [(name, one.value, *one.ci95) for name, one in self.parameters.items()]
        return html_table(["parameter", "value", "95 % from", "to"], rows,
                          f"{self.model.name}: {100.0 * self.relative_error:.2g} % of the torque or force unexplained")


@dataclass(frozen=True)
class ChannelError:
    rms: float
    floor: float  # what the best possible model would leave
    fit: float  # per cent


@dataclass(frozen=True)
class Comparison:
    combined: float  # error over floor; about 1 for a perfect model
    channels: Mapping[str, ChannelError]
    relative_error: float | None  # of the inverse model; None where the axis does not move
    json: Mapping[str, Any]

    def _repr_html_(self) -> str:
        rows = [(name, one.rms, one.floor, one.rms / one.floor if one.floor > 0.0 else "", one.fit)
                for name, one in self.channels.items()]
        return html_table(["channel", "rms", "noise floor", "times", "fit, %"], rows,
                          f"{self.combined:.3g} times the noise floor")


@dataclass(frozen=True)
class Candidate:
    kinds: Sequence[str]
    before: float  # combined, on validation data
    after: float
    confidence: float
    parameters: Mapping[str, Any]


@dataclass(frozen=True)
class Diagnosis:
    status: str
    effects: Sequence[str]  # what to add, best first
    explanation: str
    next_experiment: str
    candidates: Sequence[Candidate]
    json: Mapping[str, Any]

    def _repr_html_(self) -> str:
        rows = [(" and ".join(one.kinds), one.before, one.after, one.confidence) for one in self.candidates]
        return html_table(["effect", "before", "after", "confidence"], rows, f"{self.status}: {self.explanation}")


@dataclass(frozen=True)
class Fitted:
    """A parameter as a fit left it."""

    value: float
    deviation: float  # standard deviation, in the parameter's unit
    determined: bool  # by these data


@dataclass(frozen=True)
class Addition:
    model: Model
    before: float  # combined, on validation data
    after: float
    confidence: float
    parameters: Mapping[str, Fitted]
    json: Mapping[str, Any]


@dataclass(frozen=True)
class Rung:
    added: Sequence[str]
    train: float
    validate: float


@dataclass(frozen=True)
class Improvement:
    model: Model
    ladder: Sequence[Rung]
    stopped_because: str
    json: Mapping[str, Any]

    def _repr_html_(self) -> str:
        rows = [(", ".join(one.added) or "as it came", one.train, one.validate) for one in self.ladder]
        return html_table(["with", "training", "validation"], rows, self.stopped_because)


@dataclass(frozen=True)
class Design:
    A: NDArray[np.float64]
    B: NDArray[np.float64]
    Kobs: NDArray[np.float64]
    Kc: NDArray[np.float64]
    observer_poles: NDArray[np.complex128]
    parameters: str  # the file of the board's parameters
    json: Mapping[str, Any]


def identify(records: Records, drive: ModelLike | None = None, method: str | None = None) -> Identification:
    """Inertia (or mass), viscous and Coulomb friction. `drive`: data sheet. `method`: "sliding-ls", "unbiased-ls" or
    "ls". Raises Refused where the axis hardly moved.

    >>> found = identify("steps.csv", drive="drive.toml")
    >>> low, high = found.parameters["J_kg_m2"].ci95  # kg m^2
    >>> low < found.parameters["J_kg_m2"].value < high
    True
    """
    sheet = None if drive is None else model_source(drive)
    text, model = _host.identify(record_sources(records), sheet, method or "")
    answer = json.loads(text)
    parameters = {name: Estimate(one["value"], (one["ci95"][0], one["ci95"][1]))
                  for name, one in answer["parameters"].items()}
    return Identification(Model.parse(model), parameters, answer["relative_error"], answer["warnings"], answer)


def compare(model: ModelLike, records: Records, window_s: float | None = None) -> Comparison:
    """How well a model predicts records from their recorded command alone, over windows of `window_s` (s).

    >>> compared = compare("x.toml", "jog.csv")
    >>> compared.channels["x_mm"].rms > compared.channels["x_mm"].floor > 0.0  # mm
    True
    """
    window_s = _host.WINDOW_S if window_s is None else window_s
    answer = json.loads(_host.compare(model_source(model), record_sources(records), window_s))
    channels = {name: ChannelError(one["rms"], one["floor"], one["fit"]) for name, one in answer["channels"].items()}
    return Comparison(answer["combined"], channels, answer["relative_error"], answer)


def predict(model: ModelLike, record: RecordLike, window_s: float | None = None) -> Record:
    """The record's rows beside the model's: x_pred_mm and w_pred_rad_s (x_pred_m, v_pred_m_s).

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
    progress: Progress | None = None,
) -> Diagnosis:
    """Which physical effect the model lacks. Without `validate`, blocks of the training data are kept back to judge.
    `hold`: parameters that stay ("J_kg_m2"); `prior`: standard deviations of what the model says; `absent`: effects that
    this machine is known not to have."""
    answer = json.loads(_host.diagnose(model_source(model), record_sources(train), record_sources(validate),
                                       list(hold), _beliefs(prior), list(absent), progress))
    verdict = answer["verdict"]
    candidates = [Candidate(one["kinds"], one["before"], one["after"], one["confidence"], one["parameters"])
                  for one in answer["candidates"]]
    return Diagnosis(verdict["status"], verdict["effects"], verdict["explanation"], verdict["next_experiment"],
                     candidates, answer)


def add(
    model: ModelLike, kind: str, train: Records, validate: Records | None = None, *, over: str | None = None
) -> Addition:
    """Adds one effect at a word and fits all parameters again. `over`: coordinate of a free_curve. Raises Refused where
    no stretch of the records judges it."""
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
    progress: Progress | None = None,
) -> Improvement:
    """Adds effects while each is significant on validation data; the arguments are those of diagnose."""
    text, better = _host.improve(model_source(model), record_sources(train), record_sources(validate),
                                 list(hold), _beliefs(prior), list(absent), progress)
    answer = json.loads(text)
    ladder = [Rung(one["added"], one["train"], one["validate"]) for one in answer["ladder"]]
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
) -> Design:
    """Kalman gain and state feedback. `fc`, `zeta`: natural frequency (Hz) and damping of the closed loop; `rw`, `rwd`,
    `ru`, `rx`: variances of tachometer, disturbance, command and position; `notch`, `low_pass`: frequency in Hz, and
    after it damping and depth."""
    text, parameters = _host.design(model_source(model), fc, zeta, rw, rwd, ru, rx, _numbers(notch), _numbers(low_pass))
    answer = json.loads(text)
    poles = np.array([complex(re, im) for re, im in answer["observer_poles"]])
    return Design(np.array(answer["A"]), np.array(answer["B"]), np.array(answer["Kobs"]), np.array(answer["Kc"]), poles,
                  parameters, answer)


def _numbers(given: float | Sequence[float]) -> list[float]:
    return list(given) if isinstance(given, Sequence) else [given]
