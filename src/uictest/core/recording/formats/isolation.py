"""Reading in a process of its own, which may hang, crash or ask for too much without harm.

    python -m uictest.core.recording.formats.isolation FORMAT PATH REQUEST

is that process. By the request of :func:`read_apart` it leaves piece after piece in its working folder,
`contents.json` and one .npy file per channel, or `refusal.txt`. It says when a piece is complete, and writes
the next after a line of its input.
"""

from __future__ import annotations

import contextlib
import errno
import io
import itertools
import json
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from uictest.core import files
from uictest.core.guarded_process import bound_resources, reading_process
from uictest.core.recording.formats.file_formats import (
    LARGEST_FILE,
    READING_MEMORY,
    READING_SECONDS,
    MissingExtraError,
    ReadingInterruptedError,
    UnreadableError,
    format_of,
    module_of,
)
from uictest.core.recording.formats.layout import Dialect
from uictest.core.recording.recording import Contents, Group

_MODULE = "uictest.core.recording.formats.isolation"
REJECTED, EXTRA_MISSING, NO_ROOM = 10, 11, 12
"""Exit codes of the reading process, besides 0."""
PIECE_READY = b"piece\n"
"""What the reading process says when a piece of a long file lies in its folder; it goes on after a line."""
_KILLED = {getattr(signal, name, None) for name in ("SIGKILL", "SIGTERM", "SIGINT", "SIGHUP")}
"""Signals that come from outside; a file that crashes its reader causes others."""


def read_contents(path: Path, dialect: Dialect | None = None, seconds: float = READING_SECONDS) -> Contents:
    """Read a file of any known format. `dialect` says how a text file writes its table.

    Raises:
        UnreadableError: the file is not a recording, damaged, or too large; the message says which.
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

    `request` has the `dialect` in which all of it is one piece, or the arguments of the format's `pieces` by
    name; each piece may take so many seconds.

    Raises as :func:`read_contents`.
    """
    arguments = [name, str(path.absolute()), json.dumps(request)]
    process: Any
    with files.temporary_folder() as folder, reading_process(_MODULE, arguments, folder) as process:
        while _line_of(process, name, seconds) == PIECE_READY:
            contents = _read_contents(folder)
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
    path = folder / "refusal.txt"
    return path.read_text(encoding="utf-8") if path.exists() else ""


def _read_contents(folder: Path) -> Contents:
    form = json.loads((folder / "contents.json").read_text(encoding="utf-8"))
    dialect = None if form["dialect"] is None else Dialect.of(form["dialect"])
    groups = tuple(_read_group(of_group, folder) for of_group in form["groups"])
    return Contents(groups, form["metadata"], form["skipped"], dialect, form["guesses"])


def _read_group(form: Mapping[str, Any], folder: Path) -> Group:
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


_LONGEST_REASON = 500
_NO_ROOM = {errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC)}
"""Errors of writing temporary files; reading a file never raises them."""


def main(name: str, path: str, request: str) -> int:
    """Leave the pieces of a file in the working folder, one after the other; return the exit code."""
    asked = json.loads(request)
    bound_resources(READING_MEMORY, READING_SECONDS if "dialect" in asked else None)
    parent = os.dup(1)
    os.dup2(2, 1)  # libraries print as well

    def handed_over() -> bool:
        os.write(parent, PIECE_READY)
        return bool(sys.stdin.readline())

    return leave(Path.cwd(), name, pieces_of(name, Path(path), asked), handed_over)


def pieces_of(name: str, path: Path, request: Mapping[str, Any]) -> Iterator[Contents]:
    """Yield the whole file or its pieces, as the request says."""
    if "dialect" in request:
        yield read_here(name, path, Dialect.of(request["dialect"]))
    else:
        yield from module_of(name).pieces(path, **request)


def leave(folder: Path, name: str, pieces: Iterator[Contents], handed_over: Callable[[], bool]) -> int:
    """Write pieces into a folder, or the reason for a refusal; return the exit code.

    `handed_over` reports that a piece is ready, and returns whether the next one is wanted.
    """
    try:
        for contents in pieces:
            try:
                write_contents(contents, folder)
            except OSError:
                return NO_ROOM
            if not handed_over():
                break
    except MissingExtraError as error:
        return _write_refusal(folder, str(error), EXTRA_MISSING)
    except UnreadableError as error:
        return _write_refusal(folder, str(error))
    except MemoryError:
        return _write_refusal(folder, "reading it needs more memory than is allowed")
    # A library that meets a damaged file may raise anything at all.
    except Exception as error:
        if isinstance(error, OSError) and error.errno in _NO_ROOM:
            return NO_ROOM
        return _write_refusal(folder, f"damaged or cut off: not readable as {name} ({_name_of(error)})")
    return 0


def _name_of(error: Exception) -> str:
    """Return the name of an exception, with its module: some are called `error`."""
    module, name = type(error).__module__, type(error).__qualname__
    return name if module == "builtins" else f"{module}.{name}"


def read_here(name: str, path: Path, dialect: Dialect) -> Contents:
    """Read a file in this process."""
    module = module_of(name)
    contents: Contents = module.read(path, dialect) if name == "csv" else module.read(path)
    if not any(len(group) for group in contents.groups):
        # The longest reason says what to do.
        reasons = sorted(contents.skipped.items(), key=lambda item: -len(item[1]))
        texts = ["no channel with samples", *(f"{name!r} {reason}" for name, reason in reasons[:1])]
        texts += [f"also skipped: {', '.join(repr(name) for name, _ in reasons[1:])}"] if reasons[1:] else []
        raise UnreadableError("; ".join(texts))
    return contents


def write_contents(contents: Contents, folder: Path) -> None:
    """Write contents into a folder; names from the file never become names of files."""
    numbers = itertools.count()
    contents_form = {
        "groups": [_write_group(group, folder, numbers) for group in contents.groups],
        "metadata": contents.metadata,
        "skipped": contents.skipped,
        "guesses": contents.guesses,
        "dialect": None if contents.dialect is None else asdict(contents.dialect),
    }
    (folder / "contents.json").write_text(json.dumps(contents_form), encoding="utf-8")


def _write_group(group: Group, folder: Path, numbers: Iterator[int]) -> dict[str, Any]:
    def array_number(samples: Any) -> int:
        number, content = next(numbers), io.BytesIO()
        np.save(content, np.ascontiguousarray(samples), allow_pickle=False)
        # numpy itself writes to a full disk without an error
        (folder / f"{number}.npy").write_bytes(content.getbuffer())
        return number

    return {
        "name": group.name,
        "channels": {name: array_number(samples) for name, samples in group.channels.items()},
        "units": group.units,
        "time": None if group.time is None else array_number(np.asarray(group.time, dtype=np.float64)),
        "numbers": {name: array_number(numbers) for name, numbers in group.numbers.items()},
        "first_texts": group.first_texts,
        "first_row": group.first_row,
    }


def _write_refusal(folder: Path, reason: str, code: int = REJECTED) -> int:
    text = " ".join(reason.split())[:_LONGEST_REASON]
    try:
        (folder / "refusal.txt").write_text(text, encoding="utf-8", errors="backslashreplace")
    except OSError:
        return NO_ROOM
    return code


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
