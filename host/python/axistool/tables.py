"""Results as tables: HTML in notebooks, text elsewhere."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import NamedTuple


class Table(NamedTuple):
    """Numbers are shown with five digits; everything else as text."""

    heads: Sequence[str]
    rows: Sequence[Sequence[object]]
    caption: str = ""

    def cells(self) -> list[list[str]]:
        return [[f"{one:.5g}" if isinstance(one, float) else str(one) for one in row] for row in self.rows]


class Shown:
    """Shows its table, in a notebook as HTML."""

    def _table(self) -> Table:
        raise NotImplementedError

    def __repr__(self) -> str:
        table = self._table()
        lines = [list(table.heads), *table.cells()]
        widths = [max(len(line[k]) for line in lines) for k in range(len(table.heads))]
        text = ["  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip() for line in lines]
        return "\n".join(([table.caption] if table.caption else []) + text)

    def _repr_html_(self) -> str:
        table = self._table()
        title = f"<caption>{escape(table.caption)}</caption>" if table.caption else ""
        head = "".join(f"<th>{escape(one)}</th>" for one in table.heads)
        body = "".join("<tr>" + "".join(f"<td>{escape(one)}</td>" for one in row) + "</tr>" for row in table.cells())
        return f"<table>{title}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
