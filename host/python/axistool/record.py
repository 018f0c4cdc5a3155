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
from .tables import Shown, Table


@dataclass(repr=False)
class Record(Shown):
    """A record of n rows. columns: arrays of shape (n,) by names with units (`t_s`, `u_V`, `x_mm`, `w_rad_s`, …);
    header: the entries of the file's header.

    >>> record = Record.read("jog.csv")
    >>> record["x_mm"].shape == (len(record),), record.header["drive"]  # mm
    (True, 'x')
    """

    columns: Mapping[str, NDArray[np.float64]]
    header: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def from_arrays(cls, header: Mapping[str, str] | None = None, **columns: ArrayLike) -> Record:
        """Makes a record from columns of shape (n,), in any form that NumPy accepts, with the units in their names.

        >>> import numpy as np
        >>> t = np.arange(500) * 0.001  # s
        >>> record = Record.from_arrays(t_s=t, u_V=2.0 * np.sin(t), x_mm=10.0 * t, header={"drive": "x"})
        >>> len(record), record["x_mm"].shape
        (500, (500,))
        """
        return cls({name: np.asarray(values, dtype=np.float64) for name, values in columns.items()}, dict(header or {}))

    @classmethod
    def of(cls, given: Any) -> Record:
        """Makes a record from a path, a mapping of columns, a pandas DataFrame (a named index becomes a column), an
        xarray Dataset (its coordinates become columns) or its dict, or a NumPy array with named fields. The attrs of
        frames and datasets become the header. Raises TypeError for anything else.

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
            return cls.from_arrays(_header(getattr(given, "attrs", {})),
                                   **{str(name): named[name].to_numpy() for name in named.columns})
        if isinstance(given, Mapping) and "data_vars" in given:
            both = {**given.get("coords", {}), **given["data_vars"]}
            return cls.from_arrays(_header(given.get("attrs", {})),
                                   **{str(name): one["data"] for name, one in both.items()})
        if isinstance(given, Mapping):
            all_names = [*getattr(given, "coords", ()), *given]
            return cls.from_arrays(_header(getattr(given, "attrs", {})),
                                   **{str(name): np.asarray(given[name]) for name in all_names})
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

    def to_xarray_dict(self) -> dict[str, Any]:
        """The argument for `xarray.Dataset.from_dict`: t_s as the coordinate, the other columns over it, the header as
        attrs.

        >>> Record.of({"t_s": [0.0, 0.001], "x_mm": [1.0, 2.0]}).to_xarray_dict()["data_vars"]["x_mm"]["dims"]
        ('t_s',)
        """
        columns = {name: {"dims": ("t_s",), "data": values} for name, values in self.to_dict().items()}
        coords = {"t_s": columns.pop("t_s")} if "t_s" in columns else {}
        return {"coords": coords, "data_vars": columns, "dims": {"t_s": len(self)}, "attrs": dict(self.header)}

    def to_pandas(self) -> Any:
        """A DataFrame with the columns of the record; the header is in its attrs. Raises ImportError without pandas."""
        frame = import_module("pandas").DataFrame(self.to_dict())
        frame.attrs.update(self.header)
        return frame

    def plot(self) -> Any:
        """By matplotlib: every column over time. Returns the list of its axes; raises UsageError without matplotlib."""
        names = [name for name in self.columns if name != "t_s"]
        axes = stacked_axes(len(names))
        for name, one in zip(names, axes):
            one.plot(self["t_s"], self[name], linewidth=0.8)
            one.set_ylabel(name)
        axes[-1].set_xlabel("t_s")
        return axes

    def _table(self) -> Table:
        rows = [(name, len(values), float(np.min(values)), float(np.max(values)))
                for name, values in self.to_dict().items() if len(values)]
        return Table(["column", "rows", "least", "most"], rows, self.header.get("drive", ""))

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Record:
        """The numbers of any table or .npy file, unchecked; the functions check a record when they use it."""
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
        """Makes a record from a .mat, .h5 or .npy file, a ROS 2 bag or any table, as `axistool import` does.

        map: "t_s=t_ms*0.001,u_V=cmd,x_mm=#3". resample_s: period, s, to resample at. unwrap: range at which a column
        wraps, in its unit; {"x_mm": 6.2831853} for an angle within a turn. Raises BadInput for a bad file or mapping.

        >>> record = Record.from_log("scope.csv", "t_s=#1*0.001,i_A=#2,x_mm=#3*0.001", drive="x")
        >>> sorted(record.columns)
        ['i_A', 't_s', 'x_mm']
        """
        ranges = [f"{column}={turn!r}" for column, turn in (unwrap or {}).items()]
        columns, header = _host.import_record(os.fspath(path), map, resample_s, drive, ranges)
        return cls(columns, header)

    def checked(self) -> Record:
        """The record in the drive's own units, as the functions use it. Raises BadInput if it is not valid."""
        columns, header = _host.checked((self.columns, self.header))
        return Record(columns, header)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes a file (axis-record/1); every number reads back as the same double. Raises BadInput for columns of
        several lengths."""
        Path(path).write_text(self.text(), encoding="utf-8")

    def text(self) -> str:
        """The text of the record file."""
        lengths = {len(values) for values in self.columns.values()}
        if len(lengths) != 1:
            raise BadInput(f"the columns of a record have one length; here are {sorted(lengths)}")
        header = {"format": "axis-record/1", **self.header}
        lines = [f"# {key}: {value}" for key, value in header.items()]
        lines.append(",".join(self.columns))
        columns = [np.asarray(values, dtype=np.float64).tolist() for values in self.columns.values()]
        lines += [",".join(map(repr, row)) for row in zip(*columns)]
        return "\n".join(lines) + "\n"

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self.columns[name]

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))


def _header(attrs: Mapping[Any, Any]) -> dict[str, str]:
    return {str(key): str(value) for key, value in attrs.items()}
