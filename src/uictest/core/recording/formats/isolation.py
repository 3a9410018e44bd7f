"""Reading in a process of its own, which may hang, crash or ask for too much without harm."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import signal
import threading
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from uictest.core import files
from uictest.core.guarded_process import reading_process
from uictest.core.recording.formats.file_formats import (
    LARGEST_FILE,
    READING_SECONDS,
    MissingExtraError,
    ReadingInterruptedError,
    UnreadableError,
    format_of,
)
from uictest.core.recording.formats.layout import Dialect
from uictest.core.recording.recording import Contents, Group

_MODULE = "uictest.core.recording.formats.reader"
REJECTED, EXTRA_MISSING, NO_ROOM = 10, 11, 12
"""Exit codes of the reading process, besides 0."""
PIECE_READY = b"piece\n"
"""What the reading process says when a piece of a long file lies in its folder; it goes on after a line."""
_KILLED = {getattr(signal, name, None) for name in ("SIGKILL", "SIGTERM", "SIGINT", "SIGHUP")}
"""Signals that come from outside; a file that crashes its reader causes others."""


def read_contents(path: Path, dialect: Dialect | None = None, seconds: float = READING_SECONDS) -> Contents:
    """Read a file of any known format. `dialect` says how a text file writes its table.

    Raises:
        UnreadableError: the file is no recording, damaged, or too large; the message says which.
        MissingExtraError: the library for its format is not installed.
        ReadingInterruptedError: the temporary folder is full, or the process that reads was killed.
        OSError: the file cannot be opened.

    """
    if path.stat().st_size > LARGEST_FILE:
        raise UnreadableError(f"larger than {LARGEST_FILE // 2**20} MiB")
    if not path.is_file():
        raise UnreadableError("not a file")
    name = format_of(path)
    (contents,) = read_apart(name, path, {"dialect": asdict(dialect or Dialect())}, seconds)
    return contents


def read_apart(
    name: str, path: Path, request: Mapping[str, object], seconds: float = READING_SECONDS
) -> Iterator[Contents]:
    """Yield a file piece by piece, as another process reads it; while one is used, the next is read.

    `request` has the `dialect` in which all of it is one piece, or the arguments of `streams.PIECES` by name;
    each piece may take so many seconds.

    Raises as :func:`read_contents`.
    """
    arguments = [name, str(path.absolute()), json.dumps(request)]
    process: Any
    with files.temporary_folder() as folder, reading_process(_MODULE, arguments, folder) as process:
        while _line_of(process, name, seconds) == PIECE_READY:
            contents = _collect(folder)
            with contextlib.suppress(BrokenPipeError):
                os.write(process.stdin.fileno(), b"\n")
            yield contents
        _reject_failure(process.wait(), name, path, folder)


def _line_of(process: Any, name: str, seconds: float) -> bytes:
    """Return the next line that a process writes, nothing where it ends; it is killed where that lasts."""
    overdue = threading.Event()

    def stop() -> None:
        overdue.set()
        process.kill()

    timer = threading.Timer(seconds, stop)
    timer.start()
    try:
        line: bytes = process.stdout.readline()
    finally:
        timer.cancel()
    if overdue.is_set() and not line:
        raise UnreadableError(f"reading it as {name} did not end within {seconds:g} s")
    return line


def _reject_failure(code: int, name: str, path: Path, folder: Path) -> None:
    """Raise what the exit code of the reading process stands for."""
    if code == 0:
        return
    if code == EXTRA_MISSING:
        raise MissingExtraError(_reason_in(folder))
    if code == NO_ROOM:
        raise ReadingInterruptedError(
            errno.ENOSPC, f"{os.strerror(errno.ENOSPC)} to read {path}", str(folder.parent)
        )
    if -code in _KILLED:
        name = signal.Signals(-code).name
        raise ReadingInterruptedError(
            errno.EINTR, f"the process that reads it was killed ({name})", str(path)
        )
    raise UnreadableError(_reason_in(folder) or f"reading it as {name} ended abruptly: the file is damaged")


def _reason_in(folder: Path) -> str:
    place = folder / "refusal.txt"
    return place.read_text(encoding="utf-8") if place.exists() else ""


def _collect(folder: Path) -> Contents:
    form = json.loads((folder / "contents.json").read_text(encoding="utf-8"))
    dialect = None if form["dialect"] is None else Dialect.of(form["dialect"])
    groups = tuple(_group(each, folder) for each in form["groups"])
    return Contents(groups, form["metadata"], form["skipped"], dialect, form["guesses"])


def _group(form: Mapping[str, Any], folder: Path) -> Group:
    def array(number: int) -> Any:
        return np.load(folder / f"{number}.npy", allow_pickle=False)

    return Group(
        form["name"],
        {name: array(number) for name, number in form["channels"].items()},
        form["units"],
        None if form["time"] is None else array(form["time"]),
        {name: array(number) for name, number in form["numbers"].items()},
        form["first_texts"],
        form["first_row"],
    )
