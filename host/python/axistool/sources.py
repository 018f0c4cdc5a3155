"""What the functions take for a record, a model and a progress, and what the library takes for it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from .model import Model
from .record import Record

RecordLike: TypeAlias = Record | str | os.PathLike[str]
ModelLike: TypeAlias = Model | str | os.PathLike[str]
Records: TypeAlias = RecordLike | Iterable[RecordLike]
# Called now and then, in the caller's thread, with the share that is done (0 to 1) and what is being done; what it raises
# ends the work.
Progress: TypeAlias = Callable[[float, str], None]

RecordSource: TypeAlias = str | tuple[Mapping[str, NDArray[np.float64]], Mapping[str, str]]
ModelSource: TypeAlias = str | tuple[str]


def record_source(record: RecordLike) -> RecordSource:
    return (record.columns, record.header) if isinstance(record, Record) else os.fspath(record)


def record_sources(records: Records | None) -> list[RecordSource]:
    if records is None:
        return []
    if isinstance(records, (Record, str, os.PathLike)):
        return [record_source(records)]
    return [record_source(one) for one in records]


def model_source(model: ModelLike) -> ModelSource:
    return (model.text(),) if isinstance(model, Model) else os.fspath(model)
