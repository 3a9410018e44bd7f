"""The process that reads one file: `python -m uictest.core.recording.formats.reader FORMAT PATH REQUEST`.

By the request of `isolation.read_apart` it leaves piece after piece in its working folder, `contents.json`
and one .npy file per channel, or `refusal.txt`. It says when a piece is complete, and writes the next after a
line of its input.
"""

from __future__ import annotations

import errno
import io
import itertools
import json
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from uictest.core.guarded_process import bound_resources
from uictest.core.recording.formats import streams
from uictest.core.recording.formats.detection import read_by_itself
from uictest.core.recording.formats.file_formats import (
    READING_MEMORY,
    READING_SECONDS,
    MissingExtraError,
    UnreadableError,
    module_of,
)
from uictest.core.recording.formats.isolation import EXTRA_MISSING, NO_ROOM, PIECE_READY, REJECTED
from uictest.core.recording.formats.layout import Dialect
from uictest.core.recording.recording import Contents, Group

_LONGEST_REASON = 500
_NO_ROOM = {errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC)}
"""Errors of writing temporary files; reading a file never raises them."""


def main(name: str, path: str, request: str) -> int:
    """Leave the pieces of a file in the working folder, one after the other; return the exit code."""
    asked = json.loads(request)
    bound_resources(READING_MEMORY, READING_SECONDS if "dialect" in asked else None)
    told = os.dup(1)
    os.dup2(2, 1)  # libraries print as well

    def handed_over() -> bool:
        os.write(told, PIECE_READY)
        return bool(sys.stdin.readline())

    return leave(Path.cwd(), name, pieces_of(name, Path(path), asked), handed_over)


def pieces_of(name: str, path: Path, request: Mapping[str, Any]) -> Iterator[Contents]:
    """Yield what is asked for: all of a file, or its pieces."""
    if "dialect" in request:
        yield read_here(name, path, Dialect.of(request["dialect"]))
    else:
        yield from streams.PIECES[name](path, **request)


def leave(folder: Path, name: str, pieces: Iterator[Contents], handed_over: Callable[[], bool]) -> int:
    """Write pieces into a folder, or why there are none; return the exit code.

    `handed_over` says that one lies there, and returns whether the next one is wanted.
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
        return _reject(folder, str(error), EXTRA_MISSING)
    except UnreadableError as error:
        return _reject(folder, str(error))
    except MemoryError:
        return _reject(folder, "reading it needs more memory than is allowed")
    # A library that meets a damaged file may raise anything at all.
    except Exception as error:
        if isinstance(error, OSError) and error.errno in _NO_ROOM:
            return NO_ROOM
        return _reject(folder, f"damaged, or nothing that can be read as {name} ({type(error).__name__})")
    return 0


def read_here(name: str, path: Path, dialect: Dialect) -> Contents:
    """Read a file in this process."""
    module = module_of(name)
    if name != "csv":
        contents: Contents = module.read(path)
    else:
        contents = read_by_itself(path, dialect) if dialect.by_itself else module.read(path, dialect)
    if not any(len(group) for group in contents.groups):
        # The longest reason says what to do.
        reasons = sorted(contents.skipped.items(), key=lambda each: -len(each[1]))
        told = [f"{name!r} {reason}" for name, reason in reasons[:1]]
        told += [f"also skipped: {', '.join(repr(name) for name, _ in reasons[1:])}"] if reasons[1:] else []
        raise UnreadableError("; ".join(("no channel with samples", *told)))
    return contents


def write_contents(contents: Contents, folder: Path) -> None:
    """Write contents into a folder; names from the file never become names of files."""
    numbers = itertools.count()
    contents_form = {
        "groups": [_group_form(group, folder, numbers) for group in contents.groups],
        "metadata": contents.metadata,
        "skipped": contents.skipped,
        "guesses": contents.guesses,
        "dialect": None if contents.dialect is None else asdict(contents.dialect),
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
        "numbers": {name: array_number(numbers) for name, numbers in group.numbers.items()},
        "first_texts": group.first_texts,
        "first_row": group.first_row,
    }


def _reject(folder: Path, reason: str, code: int = REJECTED) -> int:
    text = " ".join(reason.split())[:_LONGEST_REASON]
    try:
        (folder / "refusal.txt").write_text(text, encoding="utf-8", errors="backslashreplace")
    except OSError:
        return NO_ROOM
    return code


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
