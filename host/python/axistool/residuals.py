"""What a model leaves of a record, against any coordinate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .analysis import predict
from .plots import axes_of
from .record import Record
from .sources import ModelLike, RecordLike, as_record


@dataclass(frozen=True)
class Residuals:
    """Measured less predicted, a row of the record each.

    coordinate: shape (n,), in the unit of its name; values: shape (n,), in the unit of `channel`; forward: shape (n,),
    whether the axis moves in the positive direction there.
    """

    channel: str
    against: str
    coordinate: NDArray[np.float64]
    values: NDArray[np.float64]
    forward: NDArray[np.bool_]

    def plot(self, axes: Any = None) -> Any:
        """By matplotlib, forward and backward apart; returns its axes."""
        axes = axes_of(axes)
        for which, words in ((self.forward, "forward"), (~self.forward, "backward")):
            axes.plot(self.coordinate[which], self.values[which], ".", markersize=2, label=words)
        axes.set_xlabel(self.against)
        axes.set_ylabel(f"{self.channel}: measured - predicted")
        axes.legend()
        return axes


def residuals(
    model: ModelLike, record: RecordLike, against: str = "t_s", channel: str | None = None, window_s: float | None = None
) -> Residuals:
    """Residuals of `channel` ("x_mm", "w_rad_s", …; default: the position, else the speed) against a column of the
    record ("t_s", "x_mm", "temp_C", …) or against "speed".

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
    coordinate = speed if against == "speed" else _column(against, rows, given)
    return Residuals(chosen, against, coordinate, rows[chosen] - rows[predicted], speed > 0.0)


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
