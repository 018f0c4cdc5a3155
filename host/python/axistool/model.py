"""Models (axis-model/1): the data sheet of a drive and its effects."""

from __future__ import annotations

import json
import os
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .errors import BadInput
from .tables import Shown, Table


@dataclass(repr=False)
class Model(Shown):
    """A drive's data sheet and effects. document: the file's content, which may be changed in place.

    >>> model = Model.read("x.toml")
    >>> model.effect("inertia")["J_kg_m2"] > 0.0, "coulomb" in model.kinds  # kg m^2
    (True, True)
    """

    document: dict[str, Any]

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Model:
        """Reads a model file. Raises BadInput if it cannot be read as TOML."""
        try:
            return cls(tomllib.loads(Path(path).read_text(encoding="utf-8")))
        except (OSError, tomllib.TOMLDecodeError) as fault:
            raise BadInput(f"{path}: {fault}") from fault

    @classmethod
    def parse(cls, text: str) -> Model:
        """Parses the text of a model file. Raises tomllib.TOMLDecodeError if it is not TOML."""
        return cls(tomllib.loads(text))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes a file (axis-model/1); every number reads back as the same double."""
        Path(path).write_text(self.text(), encoding="utf-8")

    def text(self) -> str:
        """The text of the model file."""
        return _toml(self.document)

    @property
    def name(self) -> str:
        """The drive's name; empty if the file has none."""
        return str(self.document.get("name", ""))

    @property
    def kinds(self) -> list[str]:
        """The kinds of the effects, in the file's order."""
        return [str(effect["kind"]) for effect in self.document.get("effect", [])]

    def effect(self, kind: str) -> dict[str, Any]:
        """The first effect of this kind. Raises KeyError if there is none."""
        for effect in self.document.get("effect", []):
            if effect["kind"] == kind:
                return dict(effect)
        raise KeyError(kind)

    def _table(self) -> Table:
        rows = []
        for effect in self.document.get("effect", []):
            rows += [(effect["kind"], key, value) for key, value in effect.items() if isinstance(value, float)]
            rows += [(effect["kind"], f"{key}, order {one['order']}", value) for one in effect.get("harmonics", [])
                     for key, value in one.items() if isinstance(value, float)]
        return Table(["effect", "parameter", "value"], rows, self.name)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {_value(one)}" for key, one in value.items()) + "}"
    return repr(value)


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(one, dict) for one in value)


def _toml(table: dict[str, Any], path: str = "") -> str:
    deeper = {key for key, value in table.items() if isinstance(value, dict) or (path == "" and _is_tables(value))}
    text = "".join(f"{key} = {_value(value)}\n" for key, value in table.items() if key not in deeper)
    for key in (key for key in table if key in deeper):
        name, value = f"{path}{key}", table[key]
        if isinstance(value, dict):
            text += f"\n[{name}]\n" + _toml(value, name + ".")
        else:
            text += "".join(f"\n[[{name}]]\n" + _toml(one, name + ".") for one in value)
    return text
