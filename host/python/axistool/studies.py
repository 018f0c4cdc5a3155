"""friction, plan, bode, circle, export, effects, scoreboard: the studies of the commands with the same names."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _host
from .analysis import require_output
from .model import Model
from .plots import axes_of, bars, stacked_axes
from .results import Estimate
from .sources import ModelLike, PathLike, Progress, RecordLike, Records, model_source, path_text, record_source, record_sources
from .tables import Shown, Table


@dataclass(frozen=True, repr=False)
class Friction(Shown):
    """A friction curve through n constant speeds. speed (n,): rad/s or m/s; effort, half_width (n,): mean friction and
    half width of its 95 % interval, Nm or N; curve (2, 122): speed and friction of the fit.

    >>> found = friction("jog.csv", "x.toml")
    >>> found.speed.shape == found.effort.shape == found.half_width.shape, found.curve.shape
    (True, (2, 122))
    """

    model: Model
    parameters: Mapping[str, Estimate]
    speed: NDArray[np.float64]
    effort: NDArray[np.float64]
    half_width: NDArray[np.float64]
    curve: NDArray[np.float64]
    json: Mapping[str, Any]

    def plot(self, axes: Any = None) -> Any:
        """By matplotlib: the friction at each speed with its 95 % interval, and the curve. Returns the axes."""
        axes = axes_of(axes)
        axes.errorbar(self.speed, self.effort, yerr=self.half_width, fmt=".", label="measured")
        axes.plot(self.curve[0], self.curve[1], label="curve")
        speed, effort = _names_of_point(self.json["points"][0])
        axes.set_xlabel(speed)
        axes.set_ylabel(effort)
        axes.legend()
        return axes

    def _table(self) -> Table:
        rows = [(name, one.value, *one.ci95) for name, one in self.parameters.items()]
        return Table(["parameter", "value", "95 % from", "to"], rows, f"{len(self.speed)} constant speeds")


@dataclass(frozen=True, repr=False)
class Plan(Shown):
    """A run that separates rival explanations. rivals: effects of each explanation; probabilities: before the run, 0 to
    1, with sum 1; expected_odds: odds of the true explanation to the next one; run: text of the run's file, empty if no
    motion separates them.

    >>> planned = plan("x.toml", "steps.csv", rivals=["backlash", "compliance"],
    ...                box="travel=40,speed=150,volts=3,time=10", most_steps=1e6)
    >>> planned.rivals, planned.probabilities
    ([['backlash'], ['compliance']], [0.5, 0.5])
    """

    rivals: Sequence[Sequence[str]]
    probabilities: Sequence[float]
    expected_odds: float
    run: str
    json: Mapping[str, Any]

    def plot(self, axes: Any = None) -> Any:
        """By matplotlib: the probability of each rival before the run. Returns the axes."""
        return bars(axes, [" + ".join(one) for one in self.rivals], {"before the run": self.probabilities}, "probability")

    def _table(self) -> Table:
        rows = [(" + ".join(kinds), probability) for kinds, probability in zip(self.rivals, self.probabilities)]
        return Table(["rival", "probability before the run"], rows, f"expected odds {self.expected_odds:.3g}")


@dataclass(frozen=True, repr=False)
class Response(Shown):
    """A frequency response at n lines. f_Hz (n,); plant (n,): complex, position (without one, speed) over command, in
    the units of json; margins: margins of the loop, None without a controller; model: the model with the measured
    compliance or delay, None without a model.

    >>> response = bode("jog.csv")
    >>> response.f_Hz.shape == response.plant.shape, response.margins is None
    (True, True)
    """

    f_Hz: NDArray[np.float64]
    plant: NDArray[np.complex128]
    margins: Mapping[str, Any] | None
    model: Model | None
    json: Mapping[str, Any]

    def plot(self) -> Any:
        """By matplotlib: magnitude and phase over frequency. Returns the list of the two axes."""
        axes = stacked_axes(2)
        axes[0].loglog(self.f_Hz, np.abs(self.plant))
        axes[0].set_ylabel("magnitude")
        axes[1].semilogx(self.f_Hz, np.degrees(np.unwrap(np.angle(self.plant))))
        axes[1].set_ylabel("phase, deg")
        axes[1].set_xlabel("Hz")
        return axes

    def _table(self) -> Table:
        rows = [(float(f), float(abs(one)), float(np.degrees(np.angle(one)))) for f, one in zip(self.f_Hz, self.plant)]
        return Table(["Hz", "magnitude", "phase, deg"], rows, f"{len(rows)} lines")


@dataclass(frozen=True)
class CircleCause:
    """A cause of a circle's error. probability: 0 to 1; um: its largest share of the radial deviation, micrometres.

    >>> CircleCause("reversal", "x", probability=0.98, um=3.1).um
    3.1
    """

    kind: str
    axis: str
    probability: float
    um: float


@dataclass(frozen=True, repr=False)
class Circle(Shown):
    """Causes of circle errors. causes: the most probable first; cannot_see: causes that these sensors cannot show.

    >>> import numpy as np
    >>> t = np.arange(8000) * 1e-3  # s: four turns of 20 mm radius, the x axis 3 um late at each reversal
    >>> x, y = 20.0 * np.cos(np.pi * t), 20.0 * np.sin(np.pi * t)
    >>> record = {"t_s": t, "x_ref_mm": x, "y_ref_mm": y, "x_mm": x + 0.003 * np.sign(y), "y_mm": y}
    >>> found = circle(record)
    >>> found.causes[0].axis, "squareness" in found.cannot_see
    ('x', True)
    """

    causes: Sequence[CircleCause]
    cannot_see: Sequence[str]
    json: Mapping[str, Any]

    def plot(self, axes: Any = None) -> Any:
        """By matplotlib: the share of each cause in micrometres. Returns the axes."""
        return bars(axes, [f"{one.kind} {one.axis}" for one in self.causes], {"share": [one.um for one in self.causes]}, "um")

    def _table(self) -> Table:
        rows = [(one.kind, one.axis, one.um, one.probability) for one in self.causes]
        return Table(["cause", "axis", "um", "probability"], rows, "cannot see: " + ", ".join(self.cannot_see))


@dataclass(frozen=True)
class Export:
    """A model in another program's format. files: text by file name; not_expressed: effects that the format lacks.

    >>> made = export("x.toml", "c", "x.h")
    >>> list(made.files), made.not_expressed
    (['x.h'], [])
    """

    files: Mapping[str, str]
    not_expressed: Sequence[str]
    json: Mapping[str, Any]

    def write(self) -> None:
        """Writes every file under its name. Raises OSError if that is impossible."""
        for path, text in self.files.items():
            Path(path).write_text(text, encoding="utf-8")


def _names_of_point(point: Mapping[str, Any]) -> tuple[str, str]:
    return ("w_rad_s", "torque_Nm") if "w_rad_s" in point else ("v_m_s", "force_N")


def friction(
    records: Records, model: ModelLike, method: str = "joint", settle_s: float = 0.3, shortest_s: float = 0.3
) -> Friction:
    """The friction curve from jogs at constant speeds in both directions.

    method: "joint" (one fit to the mean command) or "paper" (from the Kalman disturbance). settle_s: time to skip at
    the start of each constant speed, s, at least 0; shortest_s: shortest time that a speed must be held, s, above 0.
    Raises Refused if there are too few constant speeds, UsageError for an unknown method.

    >>> found = friction("jog.csv", "x.toml")
    >>> bool(np.all(np.sign(found.effort) == np.sign(found.speed)))  # friction opposes the motion
    True
    """
    text, fitted = _host.friction(record_sources(records), model_source(model), method, settle_s, shortest_s)
    answer = json.loads(text)
    points, (speed, effort) = answer["points"], _names_of_point(answer["points"][0])
    parameters = {name: Estimate(one["value"], (one["ci95"][0], one["ci95"][1]))
                  for name, one in answer["parameters"].items()}
    curve = np.array([[one[speed], one[effort]] for one in answer["curve"]]).T
    return Friction(Model.parse(fitted), parameters, np.array([one[speed] for one in points]),
                    np.array([one[effort] for one in points]),
                    np.array([0.5 * (one["ci95"][1] - one["ci95"][0]) for one in points]), curve, answer)


def plan(
    model: ModelLike,
    train: Records,
    validate: Records | None = None,
    *,
    box: str,
    rivals: Iterable[str] = (),
    most_steps: float | None = None,
    output: PathLike | None = None,
    report: PathLike | None = None,
    progress: Progress | None = None,
) -> Plan:
    """The run within a box that best separates rival explanations. Nothing moves.

    box: "travel=…,speed=…,volts=…,time=…" in mm (linear: m), mm/s, V and s. rivals: effects, "backlash+input_delay" for
    two together; by default those that diagnose cannot separate. most_steps: limit of simulated samples. output: file
    to write the run to, for `axistool excite`; a report names it. Raises AnswerIsNo if diagnose leaves nothing to
    separate, UsageError for an unknown effect or a report without an output.

    >>> planned = plan("x.toml", "steps.csv", rivals=["backlash", "compliance"],
    ...                box="travel=40,speed=150,volts=3,time=10", most_steps=1e6)
    >>> planned.expected_odds > 1.0
    True
    """
    require_output(output, report)
    text, run = _host.plan(model_source(model), record_sources(train), record_sources(validate),
                           [one.split("+") for one in rivals], box,
                           _host.MOST_STEPS if most_steps is None else most_steps, path_text(output), path_text(report),
                           progress)
    answer = json.loads(text)
    return Plan(answer["rivals"], answer["probabilities"], answer["expected_odds"], run, answer)


def bode(
    records: Records, model: ModelLike | None = None, parameters: str = "", *, report: PathLike | None = None
) -> Response:
    """The frequency response from records: of a multisine at its lines, of any other motion by Welch's method.

    model: for margins with the controller that design makes from it. parameters: text of a parameter file
    (`Design.parameters`), whose controller is used instead. Raises BadInput for records without enough excitation.

    >>> response = bode("jog.csv")
    >>> bool(np.all(np.diff(response.f_Hz) > 0.0))
    True
    """
    text, fitted = _host.bode(record_sources(records), None if model is None else model_source(model), parameters,
                              path_text(report))
    answer = json.loads(text)
    plant = np.array(answer["plant"]["re"]) + 1j * np.array(answer["plant"]["im"])
    return Response(np.array(answer["f_Hz"]), plant, answer.get("margins"), Model.parse(fitted) if fitted else None, answer)


def circle(records: Records, models: Iterable[ModelLike] = (), *, report: PathLike | None = None) -> Circle:
    """Causes of circle errors, each with its share and its probability.

    records: with x_mm, y_mm, x_ref_mm and y_ref_mm (mm), or pairs with one axis each. Sensors at the table: x2_mm,
    y2_mm or a ballbar's radius_mm. models: models of axes x and y; periods are then also given in motor turns. Raises
    Refused without a full turn at a steady feed, UsageError for a model of another axis.

    >>> t = np.arange(8000) * 1e-3  # s
    >>> x, y = 20.0 * np.cos(np.pi * t), 20.0 * np.sin(np.pi * t)  # mm
    >>> circle({"t_s": t, "x_ref_mm": x, "y_ref_mm": y, "x_mm": x + 0.003 * np.sign(y), "y_mm": y}).causes[0].axis
    'x'
    """
    answer = json.loads(_host.circle(record_sources(records), [model_source(one) for one in models], path_text(report)))
    causes = [CircleCause(one["kind"], one["axis"], one["probability"], one["um"]) for one in answer["causes"]]
    return Circle(causes, answer["cannot_see"], answer)


def export(model: ModelLike, to: str, path: PathLike, record: RecordLike | None = None) -> Export:
    """The model in another program's format; `Export.write` writes the files.

    to: "mjcf", "urdf", "linuxcnc", "c", "modelica" or "python". path: name of the file; LinuxCNC gets a .hal file
    beside it. record: record on which to compute the share of effects that the format cannot express. Raises UsageError
    for another format.

    >>> "static inline double" in export("x.toml", "c", "x.h").files["x.h"]
    True
    """
    text, files = _host.export_model(model_source(model), to, path_text(path),
                                     None if record is None else record_source(record))
    answer = json.loads(text)
    return Export(dict(files), [one["kind"] for one in answer["not_expressed"]], answer)


def effects(kind: str = "") -> list[dict[str, Any]]:
    """The catalogue of physical effects, or one of them: equation, parameters with units, similar effects.

    Raises UsageError for an unknown kind.

    >>> effects("cogging")[0]["kind"], len(effects()) > 30
    ('cogging', True)
    """
    return list(json.loads(_host.effects(kind))["effects"])


def scoreboard(
    folder: PathLike,
    *,
    cuts: bool = False,
    sample: int = 0,
    seed: int = 1,
    nulls: int = 0,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """How often diagnose is right on cases whose truth is known: the document `axis-scoreboard/1`.

    folder: cases at any depth, each a folder with model.toml, train-*.csv, validate.csv and truth.json. cuts: also
    pieces of each case. sample: number of trials, drawn at random with `seed`; 0: all. nulls: number of additional
    simulated drives without a hidden effect. Raises BadInput for a bad file or a folder without cases.

    >>> scored = scoreboard("cases")
    >>> scored["summary"]["none"]["cases"], scored["summary"]["none"]["wrong"]
    (1, 0)
    """
    return dict(json.loads(_host.scoreboard(path_text(folder), cuts, sample, seed, nulls, progress)))
