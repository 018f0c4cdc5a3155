"""Results of the analysis. `json` of each is the document that the command prints with --json.

A "combined" error is the prediction error of all channels in multiples of the noise floor (the error due to sensor
noise alone); a perfect model has about 1.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import Model
from .plots import axes_of, bars
from .tables import Shown, Table

_TIMES = "error / noise floor"


@dataclass(frozen=True)
class Estimate:
    """A parameter with its 95 % confidence interval, both in the unit that its name ends with.

    >>> inertia = Estimate(7.65e-3, (7.6e-3, 7.7e-3))  # J_kg_m2
    >>> inertia.ci95[0] < inertia.value < inertia.ci95[1]
    True
    """

    value: float
    ci95: tuple[float, float]


@dataclass(frozen=True, repr=False)
class Identification(Shown):
    """Result of identify: the model, and its parameters by name (J_kg_m2, B_Nm_s_per_rad, positive_Nm, …).

    relative_error: norm of the residual over norm of the torque or force, 0 to 1.

    >>> from axistool import identify
    >>> found = identify("steps.csv", drive="drive.toml")
    >>> 0.005 < found.parameters["J_kg_m2"].value < 0.01  # kg m^2
    True
    """

    model: Model
    parameters: Mapping[str, Estimate]
    relative_error: float
    warnings: Sequence[str]
    json: Mapping[str, Any]

    def plot(self, axes: Any = None) -> Any:
        """By matplotlib: each parameter's 95 % interval in per cent of its value. Returns the axes."""
        axes = axes_of(axes)
        for row, one in enumerate(self.parameters.values()):
            scale = 100.0 / abs(one.value) if one.value else 0.0
            half = scale * 0.5 * (one.ci95[1] - one.ci95[0])
            axes.errorbar([scale * (0.5 * (one.ci95[0] + one.ci95[1]) - one.value)], [row], xerr=[half], fmt="o", capsize=3)
        axes.set_yticks(range(len(self.parameters)), list(self.parameters))
        axes.set_xlabel("95 % interval, % of the value")
        return axes

    def _table(self) -> Table:
        rows = [(name, one.value, *one.ci95) for name, one in self.parameters.items()]
        return Table(["parameter", "value", "95 % from", "to"], rows,
                     f"{self.model.name}: {100.0 * self.relative_error:.2g} % of the torque or force unexplained")


@dataclass(frozen=True)
class ChannelError:
    """Prediction error of one channel. rms and floor (the noise floor): in the channel's unit; fit: per cent.

    >>> error = ChannelError(rms=0.012, floor=0.004, fit=99.5)  # of x_mm
    >>> round(error.rms / error.floor, 6)
    3.0
    """

    rms: float
    floor: float
    fit: float


@dataclass(frozen=True, repr=False)
class Comparison(Shown):
    """How well a model predicts records. combined: error over noise floor, about 1 for a perfect model.

    relative_error: error of the inverse model, 0 to 1; None if the axis does not move.

    >>> from axistool import compare
    >>> compared = compare("x.toml", "jog.csv")
    >>> sorted(compared.channels), compared.combined > 1.0
    (['w_rad_s', 'x_mm'], True)
    """

    combined: float
    channels: Mapping[str, ChannelError]
    relative_error: float | None
    json: Mapping[str, Any]

    def plot(self, axes: Any = None) -> Any:
        """By matplotlib: error over noise floor of each channel. Returns the axes."""
        times = [one.rms / one.floor if one.floor > 0.0 else np.nan for one in self.channels.values()]
        axes = bars(axes, list(self.channels), {"model": times}, _TIMES)
        axes.axvline(1.0, color="black", linewidth=0.8)
        return axes

    def _table(self) -> Table:
        rows = [(name, one.rms, one.floor, one.rms / one.floor if one.floor > 0.0 else "", one.fit)
                for name, one in self.channels.items()]
        return Table(["channel", "rms", "noise floor", "times", "fit, %"], rows,
                     f"{self.combined:.3g} times the noise floor")


@dataclass(frozen=True)
class Candidate:
    """Effects that were tried together. before, after: combined error on validation data; confidence: probability that
    the improvement is not chance, 0 to 1; parameters: those of the effects, by name.

    >>> tried = Candidate(["cogging"], before=9.8, after=1.05, confidence=0.99, parameters={"period_mm": 1.25})
    >>> tried.after < tried.before
    True
    """

    kinds: Sequence[str]
    before: float
    after: float
    confidence: float
    parameters: Mapping[str, Any]


@dataclass(frozen=True, repr=False)
class Diagnosis(Shown):
    """Which physical effect a model lacks. status: adequate, parameters, missing, ambiguous, unexplained or
    insufficient_data; effects: effects to add, best first.

    >>> from axistool import diagnose
    >>> found = diagnose("y.toml", "y-jog.csv", "y-valid.csv")
    >>> found.status, found.effects
    ('adequate', [])
    """

    status: str
    effects: Sequence[str]
    explanation: str
    next_experiment: str
    candidates: Sequence[Candidate]
    json: Mapping[str, Any]

    def plot(self, axes: Any = None) -> Any:
        """By matplotlib: combined error before and after each candidate. Returns the axes."""
        labels = [" and ".join(one.kinds) for one in self.candidates]
        before, after = ([getattr(one, name) for one in self.candidates] for name in ("before", "after"))
        return bars(axes, labels, {"before": before, "after": after}, _TIMES)

    def _table(self) -> Table:
        rows = [(" and ".join(one.kinds), one.before, one.after, one.confidence) for one in self.candidates]
        return Table(["effect", "before", "after", "confidence"], rows, f"{self.status}: {self.explanation}")


@dataclass(frozen=True)
class Fitted:
    """A fitted parameter. value and deviation (standard deviation): in the parameter's unit; determined: whether these
    data determine it.

    >>> fitted = Fitted(value=0.159, deviation=0.002, determined=True)  # Nm
    >>> fitted.value > 1.96 * fitted.deviation
    True
    """

    value: float
    deviation: float
    determined: bool


@dataclass(frozen=True, repr=False)
class Addition(Shown):
    """A model with one more effect. before, after: combined error on validation data; confidence: 0 to 1.

    >>> from axistool import add
    >>> added = add("z.toml", "cogging", "z-jog.csv")
    >>> 1.2 < added.parameters["cogging.period"].value < 1.3  # mm
    True
    """

    model: Model
    before: float
    after: float
    confidence: float
    parameters: Mapping[str, Fitted]
    json: Mapping[str, Any]

    def _table(self) -> Table:
        rows = [(name, one.value, one.deviation, "" if one.determined else "not determined by these data")
                for name, one in self.parameters.items()]
        return Table(["parameter", "value", "standard deviation", ""], rows,
                     f"error {self.before:.3g} -> {self.after:.3g} times the noise floor, "
                     f"{100.0 * self.confidence:.3g} % confidence")


@dataclass(frozen=True)
class ImprovementStep:
    """Effects added at one step (none at the first), and the resulting combined errors on training and validation data.

    >>> ImprovementStep(["cogging"], train=1.1, validate=1.2).validate
    1.2
    """

    added: Sequence[str]
    train: float
    validate: float


@dataclass(frozen=True, repr=False)
class Improvement(Shown):
    """The model with all significant effects, and the errors of each step.

    >>> from axistool import improve
    >>> better = improve("y.toml", "y-jog.csv", "y-valid.csv")
    >>> len(better.ladder), better.model.name
    (1, 'y')
    """

    model: Model
    ladder: Sequence[ImprovementStep]
    stopped_because: str
    json: Mapping[str, Any]

    def plot(self, axes: Any = None) -> Any:
        """By matplotlib: combined error after each step. Returns the axes."""
        labels = [", ".join(one.added) or "base re-fitted" for one in self.ladder]
        train, validate = ([getattr(one, name) for one in self.ladder] for name in ("train", "validate"))
        return bars(axes, labels, {"training": train, "validation": validate}, _TIMES)

    def _table(self) -> Table:
        rows = [(", ".join(one.added) or "base re-fitted", one.train, one.validate) for one in self.ladder]
        return Table(["with", "training", "validation"], rows, self.stopped_because)


@dataclass(frozen=True, repr=False)
class Design(Shown):
    """A controller. Plant A (2, 2), B (2,); Kalman gain Kobs (3, sensors); state feedback Kc (2,): V/mm, V/(rad/s)
    (linear: V/m, V/(m/s)); observer_poles (3,): discrete; parameters: text of the board's parameter file.

    >>> from axistool import design
    >>> made = design("x.toml", fc=25.0)  # Hz
    >>> made.Kobs.shape, made.observer_poles.shape, bool(np.all(np.abs(made.observer_poles) < 1.0))
    ((3, 2), (3,), True)
    """

    A: NDArray[np.float64]
    B: NDArray[np.float64]
    Kobs: NDArray[np.float64]
    Kc: NDArray[np.float64]
    observer_poles: NDArray[np.complex128]
    parameters: str
    json: Mapping[str, Any]

    def plot(self, axes: Any = None) -> Any:
        """By matplotlib: the observer's poles and the unit circle. Returns the axes."""
        axes = axes_of(axes)
        turn = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 181))
        axes.plot(turn.real, turn.imag, linewidth=0.8, color="grey")
        axes.plot(self.observer_poles.real, self.observer_poles.imag, "x")
        axes.set_aspect("equal")
        axes.set_xlabel("real part")
        axes.set_ylabel("imaginary part")
        return axes

    def _table(self) -> Table:
        rows = [(name, np.array2string(getattr(self, name), precision=5))
                for name in ("Kobs", "Kc", "observer_poles")]
        return Table(["", "value"], rows, "Kalman gain, state feedback, observer poles")
