"""The list of what uictest wrote in a folder, below folders that are open."""

from __future__ import annotations

import errno
import hashlib
import logging
import os
import re
import secrets
import stat
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from fnmatch import fnmatchcase
from pathlib import Path, PurePath
from typing import Final

_FOLDER: Final = os.O_RDONLY | os.O_DIRECTORY
# A FIFO must not block until somebody writes.
_FILE: Final = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK
_PARTIAL: Final = re.compile(r"\.uictest-[0-9a-f]{16}\.partial")


@contextmanager
def opened(folder: Path, below: str = "", *, make: bool = False) -> Iterator[int]:
    """Lend the descriptor of a folder.

    Args:
        folder: as the user named it; it may be a link.
        below: path of a folder below it, of names that are no links; empty for the folder itself.
        make: whether missing folders of `below` are made.

    Raises OSError.
    """
    place = os.open(folder, _FOLDER)
    try:
        for name in PurePath(below).parts:
            if make:
                with suppress(FileExistsError):
                    os.mkdir(name, dir_fd=place)
            outer, place = place, _inner(place, name)
            os.close(outer)
        yield place
    finally:
        os.close(place)


def _inner(place: int, name: str) -> int:
    if name in ("..", "/"):
        raise OSError(errno.EINVAL, "leads out of its folder", name)
    try:
        return os.open(name, _FOLDER | os.O_NOFOLLOW, dir_fd=place)
    except OSError as error:
        if is_link(place, name):
            raise OSError(errno.ELOOP, "is a link, which is not followed", name) from error
        raise


def is_link(place: int, name: str) -> bool:
    """Return whether a name in an open folder is a link."""
    with suppress(OSError):
        return stat.S_ISLNK(os.stat(name, dir_fd=place, follow_symlinks=False).st_mode)
    return False


def names_in(place: int) -> list[str]:
    """Return what an open folder holds. Raises OSError."""
    with os.scandir(place) as entries:
        return [entry.name for entry in entries]


def exists(place: int, name: str) -> bool:
    """Return whether there is anything of this name in an open folder, be it a link that leads nowhere."""
    try:
        os.stat(name, dir_fd=place, follow_symlinks=False)
    except FileNotFoundError:
        return False
    return True


def is_at(place: int, name: str, descriptor: int) -> bool:
    """Return whether an open file still has this name in an open folder."""
    try:
        there = os.stat(name, dir_fd=place, follow_symlinks=False)
    except FileNotFoundError:
        return False
    return os.path.samestat(there, os.fstat(descriptor))


@contextmanager
def opened_file(place: int, name: str, flags: int = _FILE) -> Iterator[int]:
    """Lend the descriptor of a regular file in an open folder. Raises OSError, also for anything else."""
    descriptor = os.open(name, flags | os.O_NOFOLLOW, 0o666, dir_fd=place)
    try:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise OSError(errno.EINVAL, "is no regular file", name)
        yield descriptor
    finally:
        os.close(descriptor)


def partial_name() -> str:
    """Return a name that nothing has, for what gets its own name when it is complete."""
    return f".uictest-{secrets.token_hex(8)}.partial"


def is_partial(place: int, name: str) -> bool:
    """Return whether a name in an open folder is that of an unfinished file."""
    if _PARTIAL.fullmatch(name) is None:
        return False
    return not stat.S_ISDIR(os.stat(name, dir_fd=place, follow_symlinks=False).st_mode)


LIST: Final = "SHA256SUMS"
_HEADING: Final = b"# Files that uictest wrote here and may remove; `sha256sum -c SHA256SUMS` checks them.\n"
_LINE: Final = re.compile(rb"([0-9a-f]{64})  ([^\n\\]+)\n")
_BLOCK: Final = 1 << 20


def begin_list(folder: Path) -> None:
    """Begin the list of a folder; one that is there stays, and so does a file of the user's.

    Raises OSError.
    """
    with opened(folder) as place, suppress(FileExistsError):
        _write_new(place, LIST, _HEADING)


def add_to_list(folder: Path, name: str, file: int) -> None:
    """Add an open file, which is about to get this name, to the list of a folder that has one.

    Raises OSError.
    """
    is_new = not os.path.lexists(folder / name)
    with opened(folder) as place:
        entries = _entries(place, head_only=is_new)  # a long list is not read for every file
        line = _line(name, _digest(file)) if entries is not None else b""
        if entries is None or not _LINE.fullmatch(line):
            return
        if entries.pop(name, None):
            _rewrite(place, entries)
        with opened_file(place, LIST, os.O_WRONLY | os.O_APPEND) as listing:
            os.write(listing, line)


def remove_listed(folder: Path, *patterns: str) -> None:
    """Remove listed files that are still as they were written; warn of others that match.

    Args:
        folder: it may be a link; none below it is followed.
        patterns: of the paths below the folder.

    Raises:
        OSError: something cannot be read or removed.

    """
    with opened(folder) as place:
        entries = _entries(place) or {}
        known = len(entries)
        for path, inner, name in _contents(place):
            if not any(fnmatchcase(path, pattern) for pattern in patterns):
                continue
            if _is_as_written(inner, name, entries.get(path, "")):
                os.unlink(name, dir_fd=inner)
                del entries[path]
            else:
                text = "uictest: %s stays: uictest did not write it, or it has changed since"
                logging.getLogger(__name__).warning(text, folder / path)
        if len(entries) < known:
            _rewrite(place, entries)


def foreign_paths(place: int, *ours: str) -> Iterator[str]:
    """Yield what an open folder holds that its list does not, or that has changed since it was written.

    Links and empty folders count, and so does a list that is missing. The list, unfinished files and `ours`
    belong to uictest. Raises OSError.
    """
    entries = _entries(place)
    if entries is None:
        yield LIST
    own = {*ours, *_folders_of(entries or {}), *([] if entries is None else [LIST])}
    for path, inner, name in _contents(place):
        known = path in own or is_partial(inner, name)
        if not known and not _is_as_written(inner, name, (entries or {}).get(path, "")):
            yield path


def remove_contents(place: int, *ours: str) -> list[str]:
    """Remove from an open folder all but `foreign_paths`; the list and `ours` go last, where nothing stays.

    Returns what stays directly in the folder. Raises OSError.
    """
    entries = _entries(place)
    for path, inner, name in _contents(place):
        if is_partial(inner, name) or _is_as_written(inner, name, (entries or {}).get(path, "")):
            os.unlink(name, dir_fd=inner)
    made = _folders_of(entries or {})
    for top, folders, _, inner in os.fwalk(".", topdown=False, dir_fd=place):
        for name in made.intersection(f"{_below(top)}{name}" for name in folders):
            with suppress(OSError):  # it holds something else, or is a link
                os.rmdir(name.rpartition("/")[2], dir_fd=inner)
    last = [*([] if entries is None else [LIST]), *ours]
    if stay := sorted(set(names_in(place)).difference(last)):
        return stay
    for name in last:
        with suppress(FileNotFoundError):
            os.unlink(name, dir_fd=place)
    return []


def _rewrite(place: int, entries: Mapping[str, str]) -> None:
    """Replace the list of an open folder. Raises OSError."""
    temporary = partial_name()
    _write_new(place, temporary, _HEADING + b"".join(_line(*entry) for entry in entries.items()))
    os.replace(temporary, LIST, src_dir_fd=place, dst_dir_fd=place)


def _entries(place: int, *, head_only: bool = False) -> dict[str, str] | None:
    """Return the files of a list and their digests; None where the folder has no list of uictest."""
    with suppress(OSError), opened_file(place, LIST) as listing, os.fdopen(os.dup(listing), "rb") as file:
        if file.readline(len(_HEADING)) == _HEADING:
            lines = () if head_only else map(_LINE.fullmatch, file)
            return {os.fsdecode(match[2]): match[1].decode() for match in lines if match}
    return None


def _line(name: str, digest: str) -> bytes:
    return f"{digest}  ".encode() + os.fsencode(name) + b"\n"


def _write_new(place: int, name: str, content: bytes) -> None:
    descriptor = os.open(name, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o666, dir_fd=place)
    with os.fdopen(descriptor, "wb") as file:
        file.write(content)


def _is_as_written(place: int, name: str, digest: str) -> bool:
    """Return whether a name in an open folder is a regular file of this content. Raises OSError."""
    with suppress(FileNotFoundError):
        if digest and stat.S_ISREG(os.stat(name, dir_fd=place, follow_symlinks=False).st_mode):
            with opened_file(place, name) as file:
                return _digest(file) == digest
    return False


def _digest(file: int) -> str:
    digest, offset = hashlib.sha256(), 0
    while block := os.pread(file, _BLOCK, offset):
        digest.update(block)
        offset += len(block)
    return digest.hexdigest()


def _folders_of(entries: Mapping[str, str]) -> set[str]:
    """Return the folders that were made for the files of a list."""
    return {str(above) for path in entries for above in PurePath(path).parents} - {"."}


def _contents(place: int) -> Iterator[tuple[str, int, str]]:
    """Yield path, open folder and name of every file and link below an open folder.

    An empty folder comes without a name. Raises OSError.
    """

    def fail(error: OSError) -> None:
        raise error

    for top, folders, names, inner in os.fwalk(".", onerror=fail, dir_fd=place):  # through no link
        links = [name for name in folders if is_link(inner, name)]
        for name in sorted((*names, *links)):
            yield f"{_below(top)}{name}", inner, name
        if top != "." and not (folders or names):
            yield top.removeprefix("./"), inner, ""


def _below(top: str) -> str:
    return "" if top == "." else f"{top.removeprefix('./')}/"
