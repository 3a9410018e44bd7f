"""The list of what uictest wrote in a folder."""

from __future__ import annotations

import errno
import hashlib
import logging
import os
import re
import secrets
import stat
from collections.abc import Iterator, Mapping
from contextlib import suppress
from fnmatch import fnmatchcase
from pathlib import Path, PurePath
from typing import Any, Final

_PARTIAL: Final = re.compile(r"\.uictest-[0-9a-f]{16}\.partial")


def path_below(folder: Path, name: str) -> Path:
    """Return the path of a folder below one that the user named, which may be a link.

    Raises OSError where it leads through a link, or out of the folder.
    """
    path, below = folder, PurePath(name)
    if below.anchor or ".." in below.parts:
        raise OSError(errno.EINVAL, "leads out of its folder", name)
    for part in below.parts:
        path /= part
        if path.is_symlink():
            raise OSError(errno.ELOOP, "is a link, which is not followed", str(path))
    return path


def relative_path(path: Path, folder: Path) -> str:
    """Return a path relative to a folder, with slashes; the path itself where it is on another drive."""
    with suppress(ValueError):
        path = Path(os.path.relpath(path, folder))
    return path.as_posix()


def is_file(path: Path) -> bool:
    """Return whether there is a regular file, which no link is. Raises OSError."""
    with suppress(FileNotFoundError):
        return stat.S_ISREG(path.lstat().st_mode)
    return False


def partial_name() -> str:
    """Return a name that nothing has, for what gets its own name when it is complete."""
    return f".uictest-{secrets.token_hex(8)}.partial"


def is_partial(path: Path) -> bool:
    """Return whether a path is that of an unfinished file. Raises OSError."""
    return _PARTIAL.fullmatch(path.name) is not None and not stat.S_ISDIR(path.lstat().st_mode)


LIST: Final = "SHA256SUMS"
_HEADING: Final = b"# Files that uictest wrote here and may remove; `sha256sum -c SHA256SUMS` checks them.\n"
_LINE: Final = re.compile(rb"([0-9a-f]{64})  ([^\n\\]+)\n")


def begin_list(folder: Path) -> None:
    """Begin the list of a folder; one that is there stays, and so does a file of the user's.

    Raises OSError.
    """
    with suppress(FileExistsError):
        _write_new(folder / LIST, _HEADING)


def add_to_list(folder: Path, name: str, file: Any) -> None:
    """Add an open file, which is about to get this name, to the list of a folder that has one.

    Raises OSError.
    """
    is_new = not os.path.lexists(folder / name)
    entries = _entries(folder, head_only=is_new)  # a long list is not read for every file
    line = _line(name, _digest(file)) if entries is not None else b""
    if entries is None or not _LINE.fullmatch(line):
        return
    if entries.pop(name, None):
        _rewrite(folder, entries)
    with (folder / LIST).open("ab", buffering=0) as listing:
        listing.write(line)


def remove_listed(folder: Path, *patterns: str) -> None:
    """Remove listed files that are still as they were written; warn of others that match.

    Args:
        folder: it may be a link; none below it is followed.
        patterns: of the paths below the folder.

    Raises:
        OSError: something cannot be read or removed.

    """
    entries = _entries(folder) or {}
    known = len(entries)
    for name, path in _contents(folder):
        if not any(fnmatchcase(name, pattern) for pattern in patterns):
            continue
        if _is_as_written(path, entries.get(name, "")):
            path.unlink()
            del entries[name]
        else:
            text = "uictest: %s stays: uictest did not write it, or it has changed since"
            logging.getLogger(__name__).warning(text, path)
    if len(entries) < known:
        _rewrite(folder, entries)


def foreign_paths(folder: Path, *ours: str) -> Iterator[str]:
    """Yield what a folder holds that its list does not, or that has changed since it was written.

    Links and empty folders count, and so does a list that is missing. The list, unfinished files and `ours`
    belong to uictest. Raises OSError.
    """
    entries = _entries(folder)
    if entries is None:
        yield LIST
    own = {*ours, *_folders_of(entries or {}), *([] if entries is None else [LIST])}
    for name, path in _contents(folder):
        known = name in own or is_partial(path)
        if not known and not _is_as_written(path, (entries or {}).get(name, "")):
            yield name


def remove_contents(folder: Path, *ours: str) -> list[str]:
    """Remove from a folder all but `foreign_paths` and `ours`; the list goes last, where nothing stays.

    Returns what stays directly in the folder, without `ours`. Raises OSError.
    """
    entries = _entries(folder)
    for name, path in _contents(folder):
        if is_partial(path) or _is_as_written(path, (entries or {}).get(name, "")):
            path.unlink()
    for made in sorted(_folders_of(entries or {}), reverse=True):
        with suppress(OSError):  # it holds something else, or is a link
            path_below(folder, made).rmdir()
    stay = sorted({path.name for path in folder.iterdir()}.difference(ours))
    if entries is not None and stay == [LIST]:
        (folder / LIST).unlink()
        return []
    return stay if entries is None else [name for name in stay if name != LIST]


def _rewrite(folder: Path, entries: Mapping[str, str]) -> None:
    """Replace the list of a folder. Raises OSError."""
    temporary = folder / partial_name()
    _write_new(temporary, _HEADING + b"".join(_line(*entry) for entry in entries.items()))
    temporary.replace(folder / LIST)


def _entries(folder: Path, *, head_only: bool = False) -> dict[str, str] | None:
    """Return the files of a list and their digests; None where the folder has no list of uictest."""
    with suppress(OSError):
        if is_file(folder / LIST):
            with (folder / LIST).open("rb") as file:
                if file.readline(len(_HEADING)) == _HEADING:
                    lines = () if head_only else map(_LINE.fullmatch, file)
                    return {os.fsdecode(match[2]): match[1].decode() for match in lines if match}
    return None


def _line(name: str, digest: str) -> bytes:
    return f"{digest}  ".encode() + os.fsencode(name) + b"\n"


def _write_new(path: Path, content: bytes) -> None:
    with path.open("xb") as file:
        file.write(content)


def _is_as_written(path: Path, digest: str) -> bool:
    """Return whether there is a regular file of this content. Raises OSError."""
    if not digest or not is_file(path):
        return False
    with path.open("rb") as file:
        return _digest(file) == digest


def _digest(file: Any) -> str:
    return hashlib.file_digest(file, "sha256").hexdigest()


def _folders_of(entries: Mapping[str, str]) -> set[str]:
    """Return the folders that were made for the files of a list."""
    return {above.as_posix() for name in entries for above in PurePath(name).parents} - {"."}


def _contents(folder: Path) -> Iterator[tuple[str, Path]]:
    """Yield every file, link and empty folder below a folder, as the list names it and as a path.

    Raises OSError.
    """

    def fail(error: OSError) -> None:
        raise error

    for top, folders, names in os.walk(folder, onerror=fail):  # through no link
        place = Path(top)
        paths = [place / name for name in names]
        paths += [path for path in (place / name for name in folders) if path.is_symlink()]
        if place != folder and not (folders or names):
            paths.append(place)
        yield from ((path.relative_to(folder).as_posix(), path) for path in sorted(paths))
