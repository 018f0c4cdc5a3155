"""Plots by matplotlib, where it is installed."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .errors import UsageError


def axes_of(axes: Any = None) -> Any:
    """`axes`, or new ones. Raises UsageError where matplotlib is missing."""
    if axes is not None:
        return axes
    return stacked_axes(1)[0]


def stacked_axes(count: int) -> list[Any]:
    """One above the other, over one time."""
    try:
        pyplot = import_module("matplotlib.pyplot")
    except ImportError as missing:
        raise UsageError("plot() needs matplotlib: apt-get install python3-matplotlib, or pip install matplotlib") from missing
    _, axes = pyplot.subplots(count, 1, sharex=True, squeeze=False)
    return [row[0] for row in axes]
