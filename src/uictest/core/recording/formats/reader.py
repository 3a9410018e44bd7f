"""The process that reads one file: `python -m uictest.core.recording.formats.reader FORMAT PATH DIALECT`.

It leaves `contents.json` and one .npy file per channel in its working folder, or `refusal.txt`. With a fourth
argument, the request of `isolation.read_apart`, it leaves piece after piece there: it says when one is
complete, and writes the next after a line of its input.
"""

from __future__ import annotations

import contextlib
import errno
import io
import itertools
import json
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from uictest.core.recording.formats import streams
from uictest.core.recording.formats.file_formats import (
    READING_MEMORY,
    READING_SECONDS,
    MissingExtraError,
    UnreadableError,
    module_of,
)
from uictest.core.recording.formats.isolation import EXTRA_MISSING, NO_ROOM, PIECE_READY, REJECTED, TOO_LARGE
from uictest.core.recording.formats.layout import Dialect
from uictest.core.recording.recording import Contents, Group

_LONGEST_REASON = 500
_NO_ROOM = {errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC)}
"""Errors of writing temporary files; reading a file never raises them."""


def main(name: str, path: str, dialect: str, request: str = "") -> int:
    """Read the file and leave its contents in the working folder; return the exit code."""
    _bound_resources(whole=not request)
    if not request:
        return read_into(Path.cwd(), name, Path(path), Dialect(**json.loads(dialect)))
    told = os.dup(1)
    os.dup2(2, 1)  # libraries print as well
    pieces = streams.PIECES[name](Path(path), **json.loads(request))
    return _leave(Path.cwd(), name, pieces, lambda: _handed_over(told))


def _handed_over(told: int) -> bool:
    """Say that a piece lies there; return whether the next one is wanted."""
    os.write(told, PIECE_READY)
    return bool(sys.stdin.readline())


def read_into(folder: Path, name: str, path: Path, dialect: Dialect) -> int:
    """Read the file and leave its contents, or why there are none, in a folder; return the exit code."""
    return _leave(folder, name, (read_here(name, path, dialect) for _ in range(1)), lambda: True)


def _leave(folder: Path, name: str, pieces: Iterator[Contents], handed_over: Callable[[], bool]) -> int:
    try:
        for contents in pieces:
            try:
                write_contents(contents, folder)
            except OSError:
                return NO_ROOM
            if not handed_over():
                break
    except MissingExtraError as error:
        return _reject(folder, str(error), EXTRA_MISSING)
    except UnreadableError as error:
        return _reject(folder, str(error), REJECTED)
    except MemoryError:
        return _reject(folder, "reading it needs more memory than is allowed", TOO_LARGE)
    # A library that meets a damaged file may raise anything at all.
    except Exception as error:
        if isinstance(error, OSError) and error.errno in _NO_ROOM:
            return NO_ROOM
        reason = f"damaged, or nothing that can be read as {name} ({type(error).__name__})"
        return _reject(folder, reason, REJECTED)
    return 0


def read_here(name: str, path: Path, dialect: Dialect) -> Contents:
    """Read a file in this process."""
    module = module_of(name)
    contents: Contents = module.read(path, dialect) if name == "csv" else module.read(path)
    if not any(len(group) for group in contents.groups):
        raise UnreadableError("no channel with samples")
    return contents


def write_contents(contents: Contents, folder: Path) -> None:
    """Write contents into a folder; names from the file never become names of files."""
    numbers = itertools.count()
    contents_form = {
        "groups": [_group_form(group, folder, numbers) for group in contents.groups],
        "metadata": contents.metadata,
        "skipped": contents.skipped,
    }
    (folder / "contents.json").write_text(json.dumps(contents_form), encoding="utf-8")


def _group_form(group: Group, folder: Path, numbers: Iterator[int]) -> dict[str, Any]:
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
        "first_texts": group.first_texts,
    }


def _reject(folder: Path, reason: str, code: int) -> int:
    text = " ".join(reason.split())[:_LONGEST_REASON]
    try:
        (folder / "refusal.txt").write_text(text, encoding="utf-8", errors="backslashreplace")
    except OSError:
        return NO_ROOM
    return code


def _bound_resources(*, whole: bool) -> None:
    """Limit memory and, for a `whole` file, processor time where the system can.

    Elsewhere, and for pieces, the caller's time limit must do.
    """
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (READING_MEMORY, READING_MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if whole:
            resource.setrlimit(resource.RLIMIT_CPU, (int(READING_SECONDS), int(READING_SECONDS) + 1))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
