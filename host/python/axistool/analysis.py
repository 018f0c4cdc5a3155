"""identify, compare, diagnose, add, improve, design. `json` of every result is the program's whole answer."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import Model
from .program import ModelLike, Progress, RecordLike, Workspace, run
from .record import Record

Records = RecordLike | Iterable[RecordLike]


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


@dataclass(frozen=True)
class ChannelError:
    rms: float
    floor: float  # what the best possible model would leave
    fit: float  # per cent


@dataclass(frozen=True)
class Comparison:
    combined: float  # error over floor; about 1 for a perfect model
    channels: Mapping[str, ChannelError]
    relative_error: float | None  # of the inverse model; None where the axis never slides
    json: Mapping[str, Any]


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
    """Inertia (or mass), viscous and Coulomb friction. `drive`: data sheet. Raises Refused where the axis hardly moved."""
    with Workspace() as space:
        output = space.path(".toml")
        arguments = ["identify", *space.records(records), "-o", str(output)]
        arguments += [] if drive is None else ["--drive", space.model(drive)]
        arguments += [] if method is None else ["--method", method]
        answer = run(arguments)
        parameters = {name: Estimate(one["value"], (one["ci95"][0], one["ci95"][1]))
                      for name, one in answer["parameters"].items()}
        return Identification(Model.read(output), parameters, answer["relative_error"], answer["warnings"], answer)


def compare(model: ModelLike, records: Records, window_s: float | None = None) -> Comparison:
    """How well a model predicts records from their recorded command alone."""
    with Workspace() as space:
        arguments = ["compare", space.model(model), *space.records(records)]
        answer = run(arguments + ([] if window_s is None else ["--window", repr(window_s)]))
    channels = {name: ChannelError(one["rms"], one["floor"], one["fit"]) for name, one in answer["channels"].items()}
    return Comparison(answer["combined"], channels, answer["relative_error"], answer)


def predict(model: ModelLike, record: RecordLike, window_s: float | None = None) -> Record:
    """The record's rows beside the model's: x_pred_mm and w_pred_rad_s (x_pred_m, v_pred_m_s)."""
    with Workspace() as space:
        output = space.path(".csv")
        arguments = ["compare", space.model(model), space.record(record), "--predictions", str(output)]
        run(arguments + ([] if window_s is None else ["--window", repr(window_s)]))
        return Record.read(output)


def _each(option: str, values: Iterable[str]) -> list[str]:
    return [word for value in values for word in (option, value)]


def _trained(command: list[str], space: Workspace, train: Records, validate: Records | None) -> list[str]:
    arguments = [*command, "--train", *space.records(train)]
    return arguments if validate is None else [*arguments, "--validate", *space.records(validate)]


def _known(hold: Iterable[str], prior: Mapping[str, float], absent: Iterable[str]) -> list[str]:
    beliefs = [f"{name}={deviation!r}" for name, deviation in prior.items()]
    return [*_each("--hold", hold), *_each("--prior", beliefs), *_each("--absent", absent)]


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
    with Workspace() as space:
        command = ["diagnose", space.model(model)]
        answer = run(_trained(command, space, train, validate) + _known(hold, prior, absent), progress)
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
    with Workspace() as space:
        output = space.path(".toml")
        arguments = _trained(["add", space.model(model), kind], space, train, validate) + ["-o", str(output)]
        answer = run(arguments + ([] if over is None else ["--over", over]))
        parameters = {one["name"]: Fitted(one["value"], one["deviation"], one["determined"])
                      for one in answer["parameters"]}
        return Addition(Model.read(output), answer["before"], answer["after"], answer["confidence"], parameters, answer)


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
    """Adds effects while each earns its place on validation data; the arguments are those of diagnose."""
    with Workspace() as space:
        output = space.path(".toml")
        arguments = _trained(["improve", space.model(model)], space, train, validate) + _known(hold, prior, absent)
        answer = run([*arguments, "-o", str(output)], progress)
        ladder = [Rung(one["added"], one["train"], one["validate"]) for one in answer["ladder"]]
        return Improvement(Model.read(output), ladder, answer["stopped_because"], answer)


def design(model: ModelLike, **options: float) -> Design:
    """Kalman gain and state feedback; `options` as the command has them: fc=30, zeta=0.7, rw=0.05, …"""
    with Workspace() as space:
        output = space.path(".toml")
        arguments = ["design", space.model(model), "-o", str(output)]
        for name, value in options.items():
            arguments += [f"--{name}", repr(value)]
        answer = run(arguments)
        poles = np.array([complex(re, im) for re, im in answer["observer_poles"]])
        return Design(np.array(answer["A"]), np.array(answer["B"]), np.array(answer["Kobs"]), np.array(answer["Kc"]),
                      poles, output.read_text(encoding="utf-8"), answer)
