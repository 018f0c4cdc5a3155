"""Runs the program, and lends it files for what is in memory."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeAlias

from .errors import NoSuchDevice, error_of
from .model import Model
from .record import Record

RecordLike: TypeAlias = Record | str | os.PathLike[str]
ModelLike: TypeAlias = Model | str | os.PathLike[str]


def program() -> str:
    """AXISTOOL of the environment, else the one of PATH."""
    found = os.environ.get("AXISTOOL") or shutil.which("axistool")
    if not found:
        raise NoSuchDevice("there is no program axistool on PATH: install it, or name it in the variable AXISTOOL")
    return found


class Workspace:
    """A folder for one call: what is in memory goes through it, and it is gone afterwards."""

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="axistool-")
        self._count = 0

    def __enter__(self) -> Workspace:
        return self

    def __exit__(self, *_: object) -> None:
        self._folder.cleanup()

    def path(self, ending: str) -> Path:
        self._count += 1
        return Path(self._folder.name) / f"{self._count}{ending}"

    def record(self, record: RecordLike) -> str:
        if not isinstance(record, Record):
            return os.fspath(record)
        path = self.path(".csv")
        record.write(path)
        return str(path)

    def records(self, records: RecordLike | Iterable[RecordLike]) -> list[str]:
        if isinstance(records, (Record, str, os.PathLike)):
            return [self.record(records)]
        return [self.record(one) for one in records]

    def model(self, model: ModelLike) -> str:
        if not isinstance(model, Model):
            return os.fspath(model)
        path = self.path(".toml")
        model.write(path)
        return str(path)


def end(child: subprocess.Popen[str]) -> None:
    """Ends a program as Ctrl-C does and waits until it is gone, which Popen alone does for a quarter of a second."""
    patience_s = 10.0
    child.send_signal(signal.SIGINT)
    try:
        child.wait(patience_s)
    except BaseException:
        child.kill()
        child.wait()


def run(arguments: list[str]) -> dict[str, Any]:
    """The document that `--json -` prints. Ctrl-C ends the program and comes through as KeyboardInterrupt."""
    with subprocess.Popen([program(), *arguments, "--json", "-"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True, encoding="utf-8") as child:
        try:
            said, complaint = child.communicate()
        except BaseException:
            end(child)
            raise
    if child.returncode not in (0, 1):
        raise error_of(child.returncode, complaint)
    document: dict[str, Any] = json.loads(said)
    return document
