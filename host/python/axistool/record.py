"""Records (axis-record/1) as NumPy arrays."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _host
from .errors import BadInput


@dataclass
class Record:
    """Columns by their names with units (`t_s`, `u_V`, `x_mm`, `w_rad_s`, …), all of one length, and the header's
    entries."""

    columns: Mapping[str, NDArray[np.float64]]
    header: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def from_arrays(cls, header: Mapping[str, str] | None = None, **columns: ArrayLike) -> Record:
        """Of anything that NumPy takes: Record.from_arrays(t_s=t, u_V=u, x_mm=x)."""
        return cls({name: np.asarray(values, dtype=np.float64) for name, values in columns.items()}, dict(header or {}))

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Record:
        """Numbers as the file has them, of any table (also .npy); the checks come when the record is used."""
        columns, header = _host.read_columns(os.fspath(path))
        return cls(columns, header)

    @classmethod
    def from_log(
        cls,
        path: str | os.PathLike[str],
        map: str = "",
        resample_s: float | None = None,
        drive: str = "",
        unwrap: Mapping[str, float] | None = None,
    ) -> Record:
        """Of a .mat or .npy file or any table, as `axistool import`: map="t_s=t_ms*0.001,u_V=cmd,x_mm=#3".

        unwrap: columns that begin again after so much, {"x_mm": 6.2831853} for an angle within its turn.
        """
        ranges = [f"{column}={turn!r}" for column, turn in (unwrap or {}).items()]
        columns, header = _host.import_record(os.fspath(path), map, resample_s, drive, ranges)
        return cls(columns, header)

    def checked(self) -> Record:
        """As the functions take it, in the drive's own units. Raises BadInput in the words of the program."""
        columns, header = _host.checked((self.columns, self.header))
        return Record(columns, header)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Every number reads back as the same double."""
        lengths = {len(values) for values in self.columns.values()}
        if len(lengths) != 1:
            raise BadInput(f"the columns of a record have one length; here are {sorted(lengths)}")
        header = {"format": "axis-record/1", **self.header}
        lines = [f"# {key}: {value}" for key, value in header.items()]
        lines.append(",".join(self.columns))
        columns = [np.asarray(values, dtype=np.float64).tolist() for values in self.columns.values()]
        lines += [",".join(map(repr, row)) for row in zip(*columns)]
        Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self.columns[name]

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))
