"""open, sheet, cut, shift: make records from a controller's log and a data sheet."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from . import _host
from .record import Record
from .sources import ModelLike, PathLike, RecordLike, as_record, model_source, path_text, record_source
from .tables import Shown, Table


@dataclass(frozen=True, repr=False)
class Opening(Shown):
    """Records made from logs. records: by file name; axes: axis of each record, by file name, empty if the log has only
    one axis; asks: uncertain channels (correct them with `map`); missing: missing information; mapping: text of a
    mapping file, for `map` with the next log of that machine.

    >>> opened = open_logs("scope.csv", drive="x")
    >>> [sorted(record.columns) for record in opened.records.values()]
    [['i_A', 't_s', 'w_rad_s', 'x_mm']]
    """

    records: Mapping[str, Record]
    axes: Mapping[str, str]
    asks: Sequence[str]
    missing: Sequence[str]
    mapping: str
    json: Mapping[str, Any]

    def _table(self) -> Table:
        rows = [(file["file"], one["name"], one["taken_as"] or "-", one["factor"], one["sure"], one["why"])
                for file in self.json["files"] for one in file["channels"]]
        return Table(["log", "channel", "taken as", "factor", "sure", "why"], rows, "; ".join(self.asks))


def open_logs(
    logs: PathLike | Iterable[PathLike],
    *,
    sheet: ModelLike | None = None,
    kt: float | None = None,
    map: str = "",
    hal: PathLike | None = None,
    period_s: float | None = None,
    drive: str = "",
) -> Opening:
    """Records from any controller's logs, as made by `axistool open`, which recognises channels by their names, units
    and physical relations.

    sheet: data sheet of the drive. kt: only its motor constant, Nm/A (linear: N/A). map: "x_mm=pos*0.001,…" or a
    mapping file, to override the recognised channels. hal: the .hal file that names halsampler's columns. period_s:
    sampling period, s, of a log that does not state it. drive: name for the records. Raises BadInput for a file that
    cannot be read.

    >>> opened = open_logs("scope.csv", drive="x")
    >>> record, = opened.records.values()
    >>> record["x_mm"].shape == record["t_s"].shape, list(opened.asks)
    (True, [])
    """
    paths = [path_text(logs)] if isinstance(logs, (str, os.PathLike)) else [path_text(one) for one in logs]
    text, made, mapping = _host.open_logs(paths, None if sheet is None else model_source(sheet), map, path_text(hal),
                                          drive, kt, period_s)
    answer = json.loads(text)
    missing = [one for file in answer["files"] for one in file["missing"]]
    return Opening({name: Record(*columns) for name, _, columns in made}, {name: axis for name, axis, _ in made},
                   answer["asks"], missing, mapping, answer)


def sheet(
    name: str,
    kind: str,
    *,
    effort: str = "current",
    kt: float | None = None,
    lead_mm: float | None = None,
    step_mm: float | None = None,
    period_s: float | None = None,
) -> str:
    """A commented data sheet to fill in (axis-model/1), with the values that are known.

    kind: "rotary" or "linear". effort: quantity in the logs, "current" or "voltage". kt: motor constant, Nm/A or N/A;
    lead_mm: travel per motor turn; step_mm: travel per encoder count; period_s: sampling period, s; all above 0. Raises
    ValueError for another kind or effort.

    >>> text = sheet("x", "rotary", kt=0.4769, lead_mm=10.0, step_mm=10.0 / 4096, period_s=0.001)
    >>> "torque_constant_Nm_per_A = 0.4769" in text
    True
    """
    if kind not in ("rotary", "linear") or effort not in ("current", "voltage"):
        raise ValueError(f"kind {kind!r}, effort {effort!r}: expected rotary or linear, current or voltage")
    return _host.sheet(name, kind == "rotary", effort == "current", kt, lead_mm, step_mm, period_s)


def cut(record: RecordLike, from_s: float = -math.inf, to_s: float = math.inf) -> Record:
    """The rows of a record from `from_s` to `to_s` (s, both included). Time stamps stay unchanged.

    Raises UsageError if no row remains, BadInput if the rest is not a valid record.

    >>> part = cut("jog.csv", from_s=1.0, to_s=2.0)
    >>> len(part), part["x_mm"].shape, float(part["t_s"][0])
    (1001, (1001,), 1.0)
    """
    if isinstance(record, (str, os.PathLike)):
        return Record(*_host.cut(os.fspath(record), "", from_s, to_s))
    return Record(*_host.cut("the record", as_record(record).text(), from_s, to_s))


def shift(record: RecordLike, channel: str, by_s: float) -> Record:
    """The record with one channel later by `by_s` (s; negative: earlier). Rows at the ends without a value are cut off.

    Raises UsageError for an unknown channel.

    >>> moved = shift("jog.csv", "w_rad_s", 0.002)
    >>> len(as_record("jog.csv")) - len(moved)
    2
    """
    return Record(*_host.shift(record_source(record), channel, by_s))
