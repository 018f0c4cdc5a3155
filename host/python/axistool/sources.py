"""Types that the functions accept for records, models and progress, and their conversion for the library."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from .model import Model
from .record import Record

# Record.of accepts all of them; Any includes a pandas DataFrame or an array with named fields.
RecordLike: TypeAlias = Record | str | os.PathLike[str] | Mapping[str, Any] | Any
PathLike: TypeAlias = str | os.PathLike[str]
ModelLike: TypeAlias = Model | PathLike
Records: TypeAlias = RecordLike | Iterable[RecordLike]
# Called from time to time in the caller's thread with the finished share (0 to 1) and a description of the work. An
# exception ends the work.
Progress: TypeAlias = Callable[[float, str], None]

RecordSource: TypeAlias = str | tuple[Mapping[str, NDArray[np.float64]], Mapping[str, str]]
ModelSource: TypeAlias = str | tuple[str]


def as_record(given: RecordLike) -> Record:
    """Raises TypeError, with a hint how to make a model, if the argument is not a model."""
    return Record.of(given)


def path_text(path: PathLike | None) -> str:
    return "" if path is None else os.fspath(path)


def record_source(record: RecordLike) -> RecordSource:
    if isinstance(record, (str, os.PathLike)):
        return os.fspath(record)
    one = as_record(record)
    return (one.columns, one.header)


def record_sources(records: Records | None) -> list[RecordSource]:
    if records is None:
        return []
    if isinstance(records, Iterable) and not isinstance(records, (str, Mapping)) and not hasattr(records, "dtype"):
        if not hasattr(records, "to_numpy"):  # a DataFrame is one record
            return [record_source(one) for one in records]
    return [record_source(records)]


def model_source(model: ModelLike) -> ModelSource:
    return (model.text(),) if isinstance(model, Model) else os.fspath(model)
