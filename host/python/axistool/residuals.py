"""Residuals of a model on a record over any coordinate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .analysis import predict
from .plots import axes_of
from .record import Record
from .sources import ModelLike, RecordLike, as_record
from .tables import Shown, Table


@dataclass(frozen=True, repr=False)
class Residuals(Shown):
    """Measured minus predicted, one value for each of the record's n rows.

    coordinate (n,): in the unit of its name; values (n,): in the unit of `channel`; forward (n,): whether the axis
    moves in the positive direction.

    >>> left = residuals("x.toml", "jog.csv", against="speed")
    >>> left.values.shape == left.forward.shape
    True
    """

    channel: str
    against: str
    coordinate: NDArray[np.float64]
    values: NDArray[np.float64]
    forward: NDArray[np.bool_]

    def plot(self, axes: Any = None) -> Any:
        """By matplotlib: forward and backward in two colours. Returns the axes; raises UsageError without matplotlib."""
        axes = axes_of(axes)
        for which, words in ((self.forward, "forward"), (~self.forward, "backward")):
            axes.plot(self.coordinate[which], self.values[which], ".", markersize=2, label=words)
        axes.set_xlabel(self.against)
        axes.set_ylabel(f"{self.channel}: measured - predicted")
        axes.legend()
        return axes

    def _table(self) -> Table:
        rows = [(words, int(np.count_nonzero(which)), float(np.sqrt(np.mean(self.values[which] ** 2))))
                for which, words in ((self.forward, "forward"), (~self.forward, "not forward")) if np.any(which)]
        return Table(["direction", "rows", "rms"], rows, f"{self.channel}: measured - predicted")


def residuals(
    model: ModelLike,
    record: RecordLike,
    against: str | ArrayLike = "t_s",
    channel: str | None = None,
    window_s: float | None = None,
) -> Residuals:
    """Residuals of a channel against a coordinate.

    channel: "x_mm", "w_rad_s", …; by default the position, else the speed. against: a column of the record ("t_s",
    "x_mm", "temp_C", …), "speed", or an array of shape (n,) of your own. window_s: as for compare. Raises KeyError
    for an unknown channel or column, ValueError for an array of another shape.

    >>> left = residuals("x.toml", "jog.csv", against="x_mm")
    >>> left.values.shape == left.coordinate.shape
    True
    """
    given = as_record(record)
    rows = predict(model, given, window_s)
    measured = [name for name in ("x_mm", "x_m", "x2_mm", "x2_m", "w_rad_s", "v_m_s") if name in rows.columns]
    chosen = channel or measured[0]
    predicted = {"x_mm": "x_pred_mm", "x_m": "x_pred_m", "x2_mm": "x2_pred_mm", "x2_m": "x2_pred_m",
                 "w_rad_s": "w_pred_rad_s", "v_m_s": "v_pred_m_s"}.get(chosen)
    if predicted is None or predicted not in rows.columns:
        raise KeyError(f"channel {chosen!r} is not predicted; there is {', '.join(measured)}")
    speed = _speed(rows)
    if not isinstance(against, str):
        name, coordinate = "coordinate", np.asarray(against, dtype=np.float64)
        if coordinate.shape != speed.shape:
            raise ValueError(f"against has shape {coordinate.shape}; the record has {speed.shape}")
    else:
        name, coordinate = against, speed if against == "speed" else _column(against, rows, given)
    return Residuals(chosen, name, coordinate, rows[chosen] - rows[predicted], speed > 0.0)


def _speed(rows: Record) -> NDArray[np.float64]:
    for name in ("w_rad_s", "v_m_s"):
        if name in rows.columns:
            return rows[name]
    position = rows["x_mm"] if "x_mm" in rows.columns else rows["x_m"]
    return np.asarray(np.gradient(position, rows["t_s"]), dtype=np.float64)


def _column(name: str, rows: Record, given: Record) -> NDArray[np.float64]:
    if name in rows.columns:
        return rows[name]
    if name not in given.columns or len(given) != len(rows):
        raise KeyError(f"{name!r} is no column of this record; there is {', '.join(given.columns)} and speed")
    return np.asarray(given[name], dtype=np.float64)
