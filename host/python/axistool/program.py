"""Runs the program, and lends it files for what is in memory."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import tempfile
import threading
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import IO, Any, TypeAlias

from .errors import NoSuchDevice, error_of
from .model import Model
from .record import Record

RecordLike: TypeAlias = Record | str | os.PathLike[str]
ModelLike: TypeAlias = Model | str | os.PathLike[str]
# Called now and then, in the caller's thread, with the share that is done (0 to 1) and what is being done; what it raises
# ends the program.
Progress: TypeAlias = Callable[[float, str], None]


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


def _complaints(lines: IO[str], progress: Progress | None) -> str:
    """What the program says on its error stream, without the lines that tell its progress."""
    said = ""
    for line in lines:
        mark, _, rest = line.partition(" ")
        if progress is None or mark != "progress":
            said += line
            continue
        share, _, what = rest.strip().partition(" ")
        progress(float(share), what)
    return said


def run(arguments: list[str], progress: Progress | None = None) -> dict[str, Any]:
    """The document that `--json -` prints. Ctrl-C ends the program and comes through as KeyboardInterrupt."""
    environment = {name: value for name, value in os.environ.items() if name != "AXIS_PROGRESS"}
    if progress is not None:
        environment["AXIS_PROGRESS"] = "lines"
    with subprocess.Popen([program(), *arguments, "--json", "-"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True, encoding="utf-8", env=environment) as child:
        assert child.stdout is not None and child.stderr is not None
        said: list[str] = []
        reader = threading.Thread(target=lambda lines: said.extend(lines), args=(child.stdout,), daemon=True)
        reader.start()
        try:
            complaint = _complaints(child.stderr, progress)
            child.wait()
        except BaseException:
            end(child)
            raise
        finally:
            reader.join()
    if child.returncode not in (0, 1):
        raise error_of(child.returncode, complaint)
    document: dict[str, Any] = json.loads("".join(said))
    return document
