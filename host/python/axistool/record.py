"""Records (axis-record/1) as NumPy arrays."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _host
from .errors import BadInput
from .plots import stacked_axes
from .tables import html_table


@dataclass
class Record:
    """Columns by their names with units (`t_s`, `u_V`, `x_mm`, `w_rad_s`, …), all of one length, and the header's
    entries."""

    columns: Mapping[str, NDArray[np.float64]]
    header: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def from_arrays(cls, header: Mapping[str, str] | None = None, **columns: ArrayLike) -> Record:
        """Of anything that NumPy takes, one-dimensional and of one length, with the units in the names.

        >>> import numpy as np
        >>> t = np.arange(500) * 0.001  # s
        >>> record = Record.from_arrays(t_s=t, u_V=2.0 * np.sin(t), x_mm=10.0 * t, header={"drive": "x"})
        >>> len(record), record["x_mm"].shape
        (500, (500,))
        """
        return cls({name: np.asarray(values, dtype=np.float64) for name, values in columns.items()}, dict(header or {}))

    @classmethod
    def of(cls, given: Any) -> Record:
        """Of a path, a mapping of columns (a dict, an xarray Dataset), a pandas DataFrame (its index counts where it has
        a name), or a NumPy array with named fields. Raises TypeError for anything else.

        >>> Record.of({"t_s": [0.0, 0.001], "x_mm": [1.0, 2.0]})["x_mm"].tolist()
        [1.0, 2.0]
        """
        if isinstance(given, Record):
            return given
        if isinstance(given, (str, os.PathLike)):
            return cls.read(given)
        if hasattr(given, "columns") and hasattr(given, "to_numpy"):
            index = getattr(given.index, "name", None)
            named = given.reset_index() if index is not None else given
            header = {str(key): str(value) for key, value in dict(getattr(given, "attrs", {})).items()}
            return cls.from_arrays(header, **{str(name): named[name].to_numpy() for name in named.columns})
        if isinstance(given, Mapping):
            return cls.from_arrays(None, **{str(name): np.asarray(given[name]) for name in given})
        names = getattr(getattr(given, "dtype", None), "names", None)
        if names:
            return cls.from_arrays(None, **{name: given[name] for name in names})
        raise TypeError(
            f"{type(given).__name__} is no record: give a path, a Record, or a dict or DataFrame of columns; arrays take "
            "names with units first: Record.from_arrays(t_s=t, u_V=u, x_mm=x)"
        )

    def to_dict(self) -> dict[str, NDArray[np.float64]]:
        """The columns by their names."""
        return {name: np.asarray(values, dtype=np.float64) for name, values in self.columns.items()}

    def to_pandas(self) -> Any:
        """A DataFrame with a column each; the header is in its attrs. Raises ImportError without pandas."""
        frame = import_module("pandas").DataFrame(self.to_dict())
        frame.attrs.update(self.header)
        return frame

    def plot(self) -> Any:
        """By matplotlib, every column over time; returns the list of its axes."""
        names = [name for name in self.columns if name != "t_s"]
        axes = stacked_axes(len(names))
        for name, one in zip(names, axes):
            one.plot(self["t_s"], self[name], linewidth=0.8)
            one.set_ylabel(name)
        axes[-1].set_xlabel("t_s")
        return axes

    def _repr_html_(self) -> str:
        rows = [(name, len(values), float(np.min(values)), float(np.max(values)))
                for name, values in self.to_dict().items() if len(values)]
        return html_table(["column", "rows", "least", "most"], rows, self.header.get("drive", ""))

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
