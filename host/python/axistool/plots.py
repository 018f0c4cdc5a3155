"""Plots by matplotlib, if it is installed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import Any

from .errors import UsageError


def axes_of(axes: Any = None) -> Any:
    """`axes`, or new axes. Raises UsageError if matplotlib is missing."""
    if axes is not None:
        return axes
    return stacked_axes(1)[0]


def stacked_axes(count: int) -> list[Any]:
    """`count` axes, one above the other, with a common horizontal axis. Raises UsageError if matplotlib is missing."""
    try:
        pyplot = import_module("matplotlib.pyplot")
    except ImportError as missing:
        raise UsageError("plot() needs matplotlib: apt-get install python3-matplotlib, or pip install matplotlib") from missing
    _, axes = pyplot.subplots(count, 1, sharex=True, squeeze=False)
    return [row[0] for row in axes]


def bars(axes: Any, labels: Sequence[str], series: Mapping[str, Sequence[float]], unit: str) -> Any:
    """Horizontal bars: a group for each label, from top to bottom, and a colour for each series. Returns the axes."""
    axes = axes_of(axes)
    height = 0.8 / max(1, len(series))
    for number, (name, values) in enumerate(series.items()):
        axes.barh([row + number * height for row in range(len(labels))], values, height, label=name)
    axes.set_yticks(range(len(labels)), labels)
    axes.invert_yaxis()
    axes.set_xlabel(unit)
    axes.legend()
    return axes
