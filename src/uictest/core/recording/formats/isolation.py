"""Reading in a process of its own, which may hang, crash or ask for too much without harm."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from uictest.core import files
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
REJECTED, EXTRA_MISSING, TOO_LARGE, NO_ROOM = 10, 11, 12, 13
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
    with files.temporary_folder() as folder:
        _run(name, path, dialect or Dialect(), folder, seconds)
        return _collect(folder)


def read_apart(
    name: str, path: Path, request: Mapping[str, object], seconds: float = READING_SECONDS
) -> Iterator[Contents]:
    """Yield a long file piece by piece; while one is used, the next is read.

    `request` has the arguments of `streams.PIECES` by name; each piece may take so many seconds.

    Raises as :func:`read_contents`.
    """
    with files.temporary_folder() as folder:
        command = _command(name, path, Dialect(), json.dumps(request))
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
        process: Any
        with subprocess.Popen(command, **{**_surroundings(folder), **pipes}) as process:
            try:
                while _says(process, name, seconds) == PIECE_READY:
                    contents = _collect(folder)
                    with contextlib.suppress(BrokenPipeError):
                        os.write(process.stdin.fileno(), b"\n")
                    yield contents
                _reject_failure(process.wait(), name, path, folder)
            finally:
                process.kill()


def _says(process: Any, name: str, seconds: float) -> bytes:
    """Return the next line that a process writes, nothing where it ends; it is killed where that lasts."""
    overdue = threading.Event()

    def stop() -> None:
        overdue.set()
        process.kill()

    timer = threading.Timer(seconds, stop)
    timer.start()
    line: bytes = process.stdout.readline()
    timer.cancel()
    if overdue.is_set() and not line:
        raise UnreadableError(_too_slow(name, seconds))
    return line


def _too_slow(name: str, seconds: float) -> str:
    return f"reading it as {name} did not end within {seconds:g} s"


def _command(name: str, path: Path, dialect: Dialect, *request: str) -> list[str]:
    # -I: neither the environment nor the working folder, where the file may lie, decides what is imported.
    # -B: on a full disk Python could leave half a compiled module, which every later reader would fail on.
    flags = ["-I", "-B", "-m", _MODULE]
    return [sys.executable, *flags, name, str(path.absolute()), json.dumps(asdict(dialect)), *request]


def _surroundings(folder: Path) -> dict[str, Any]:
    return {
        "cwd": folder,
        "env": {**os.environ, **dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(folder))},
        **dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL),
    }


def _read_in_process(name: str, path: Path, dialect: Dialect, folder: Path, seconds: float) -> int:
    """Return the exit code of a process that reads a file into a folder."""
    command = _command(name, path, dialect)
    done = subprocess.run(command, **_surroundings(folder), timeout=seconds, check=False)
    return done.returncode


def _run(name: str, path: Path, dialect: Dialect, folder: Path, seconds: float) -> None:
    try:
        code = _read_in_process(name, path, dialect, folder, seconds)
    except subprocess.TimeoutExpired as error:
        raise UnreadableError(_too_slow(name, seconds)) from error
    _reject_failure(code, name, path, folder)


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
    return Contents(tuple(_group(each, folder) for each in form["groups"]), form["metadata"], form["skipped"])


def _group(form: Mapping[str, Any], folder: Path) -> Group:
    def array(number: int) -> Any:
        return np.load(folder / f"{number}.npy", allow_pickle=False)

    return Group(
        form["name"],
        {name: array(number) for name, number in form["channels"].items()},
        form["units"],
        None if form["time"] is None else array(form["time"]),
        form["first_texts"],
    )
