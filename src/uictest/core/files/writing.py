"""Files that appear whole or not at all, temporary folders, and the list of what uictest wrote."""

from __future__ import annotations

import errno
import hashlib
import logging
import os
import re
import secrets
import shutil
import stat
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from fnmatch import fnmatchcase
from pathlib import Path, PurePath
from typing import Any, BinaryIO, Final

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
    """Return whether a path is a regular file, not a link. Raises OSError."""
    with suppress(FileNotFoundError):
        return stat.S_ISREG(path.lstat().st_mode)
    return False


def partial_name() -> str:
    """Return a name that nothing has, for what gets its own name when it is complete."""
    return f".uictest-{secrets.token_hex(8)}.partial"


def is_partial(path: Path) -> bool:
    """Return whether a path is an unfinished file. Raises OSError."""
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
    entries = _listed_digests(folder, head_only=is_new)  # a long list is not read for every file
    line = _list_line(name, _sha256_of(file)) if entries is not None else b""
    if entries is None or not _LINE.fullmatch(line):
        return
    if entries.pop(name, None):
        _rewrite_list(folder, entries)
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
    entries = _listed_digests(folder) or {}
    known = len(entries)
    for name, path in _paths_below(folder):
        if not any(fnmatchcase(name, pattern) for pattern in patterns):
            continue
        if _is_as_written(path, entries.get(name, "")):
            path.unlink()
            del entries[name]
        else:
            text = "uictest: %s stays: uictest did not write it, or it has changed since"
            logging.getLogger(__name__).warning(text, path)
    if len(entries) < known:
        _rewrite_list(folder, entries)


def foreign_paths(folder: Path, *ours: str) -> Iterator[str]:
    """Yield the paths below a folder that its list lacks, or that have changed since they were written.

    Links and empty folders count, and so does a list that is missing. The list, unfinished files and `ours`
    belong to uictest. Raises OSError.
    """
    entries = _listed_digests(folder)
    if entries is None:
        yield LIST
    of_uictest = {*ours, *_folders_of_entries(entries or {}), *([] if entries is None else [LIST])}
    for name, path in _paths_below(folder):
        known = name in of_uictest or is_partial(path)
        if not known and not _is_as_written(path, (entries or {}).get(name, "")):
            yield name


def remove_contents(folder: Path, *ours: str) -> list[str]:
    """Remove from a folder all but `foreign_paths` and `ours`; the list goes last, where nothing stays.

    Returns what stays directly in the folder, without `ours`. Raises OSError.
    """
    entries = _listed_digests(folder)
    for name, path in _paths_below(folder):
        if is_partial(path) or _is_as_written(path, (entries or {}).get(name, "")):
            path.unlink()
    for made in sorted(_folders_of_entries(entries or {}), reverse=True):
        with suppress(OSError):  # it holds something else, or is a link
            path_below(folder, made).rmdir()
    stay = sorted({path.name for path in folder.iterdir()}.difference(ours))
    if entries is not None and stay == [LIST]:
        (folder / LIST).unlink()
        return []
    return stay if entries is None else [name for name in stay if name != LIST]


def _rewrite_list(folder: Path, entries: Mapping[str, str]) -> None:
    temporary = folder / partial_name()
    _write_new(temporary, _HEADING + b"".join(_list_line(*entry) for entry in entries.items()))
    temporary.replace(folder / LIST)


def _listed_digests(folder: Path, *, head_only: bool = False) -> dict[str, str] | None:
    """Return the files of a list and their digests; None where the folder has no list of uictest."""
    with suppress(OSError):
        if is_file(folder / LIST):
            with (folder / LIST).open("rb") as file:
                if file.readline(len(_HEADING)) == _HEADING:
                    lines = () if head_only else map(_LINE.fullmatch, file)
                    return {os.fsdecode(match[2]): match[1].decode() for match in lines if match}
    return None


def _list_line(name: str, digest: str) -> bytes:
    return f"{digest}  ".encode() + os.fsencode(name) + b"\n"


def _write_new(path: Path, content: bytes) -> None:
    with path.open("xb") as file:
        file.write(content)


def _is_as_written(path: Path, digest: str) -> bool:
    if not digest or not is_file(path):
        return False
    with path.open("rb") as file:
        return _sha256_of(file) == digest


def _sha256_of(file: Any) -> str:
    return hashlib.file_digest(file, "sha256").hexdigest()


def _folders_of_entries(entries: Mapping[str, str]) -> set[str]:
    """Return the folders that were made for the files of a list."""
    return {above.as_posix() for name in entries for above in PurePath(name).parents} - {"."}


def _paths_below(folder: Path) -> Iterator[tuple[str, Path]]:
    """Yield every file, link and empty folder below a folder, as the list names it and as a path.

    Raises OSError.
    """

    def fail(error: OSError) -> None:
        raise error

    for top, folders, names in os.walk(folder, onerror=fail):  # through no link
        below = Path(top)
        paths = [below / name for name in names]
        paths += [path for path in (below / name for name in folders) if path.is_symlink()]
        if below != folder and not (folders or names):
            paths.append(below)
        yield from ((path.relative_to(folder).as_posix(), path) for path in sorted(paths))


class WriteError(OSError):
    """A file or folder that cannot be written: `filename`. Its text says so, with the reason."""

    def __str__(self) -> str:
        return f"cannot write {self.filename}: {self.strerror}"


@contextmanager
def writing(target: Path, *, only_nameless: bool = False) -> Iterator[None]:
    """Let an error of the system be a WriteError of what the user named, or of a file in it.

    With `only_nameless`, an error about a file that it names is left as it is.
    """
    try:
        yield
    except WriteError:
        raise
    except OSError as error:
        if only_nameless and (error.errno is None or error.filename is not None):
            raise
        path = Path(error.filename or target)
        is_hidden = any(part.endswith(".partial") for part in path.parts)
        named = path if path.is_relative_to(target) and not is_hidden else target
        raise WriteError(error.errno, error.strerror or str(error), str(named)) from error


@contextmanager
def new_file(folder: Path, name: str, *, private: bool = False, listed: bool = True) -> Iterator[BinaryIO]:
    """Lend a file to write, which appears as `folder/name` if the block succeeds.

    If the block raises, a file of this name stays as it was, no other is left, and the exception propagates.

    Args:
        folder: as the user named it; it may be a link.
        name: of the file, or its path below the folder, through no link; missing folders are made.
        private: whether only this user can read and write it, in a folder of uictest's own: whatever stands
            in its place is replaced.
        listed: whether it is added to the list of the folder, where there is one.

    Raises:
        WriteError: the folder is missing, full or not writable.

    """
    below, last = PurePath(name).parent.as_posix(), PurePath(name).name
    with ExitStack() as undo:
        with writing(folder / name):
            above = path_below(folder, below)
            folder.stat()  # which is not made
            undo.callback(remove_empty, make_folder(above, target=folder / name))
            if last in ("", ".."):
                raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), name)
            if not private:
                _require_replaceable(above / last)
            temporary = above / partial_name()
            temporary.touch(0o600 if private else 0o666, exist_ok=False)
            undo.callback(temporary.unlink, missing_ok=True)
            new = undo.enter_context(temporary.open("r+b"))
        with writing(folder / name, only_nameless=True), new:
            yield new
        with writing(folder / name):
            with temporary.open("r+b") as file:
                os.fsync(file.fileno())
                if listed:
                    add_to_list(folder, PurePath(name).as_posix(), file)
            temporary.replace(above / last)


def _require_replaceable(path: Path) -> None:
    """Raise FileExistsError for a device or a pipe: a rename would put a file in the place of `/dev/null`."""
    with suppress(FileNotFoundError):
        mode = path.lstat().st_mode
        if not (stat.S_ISREG(mode) or stat.S_ISLNK(mode) or stat.S_ISDIR(mode)):
            raise FileExistsError(errno.EEXIST, "no file, and not replaced by one", path.name)


def write(
    folder: Path, name: str, content: bytes | str, *, private: bool = False, listed: bool = True
) -> None:
    """Write a file as `new_file` does: bytes, or a text as UTF-8 with its line ends. Raises WriteError."""
    with new_file(folder, name, private=private, listed=listed) as file:
        file.write(content if isinstance(content, bytes) else content.encode("utf-8"))


def write_to(path: Path, content: bytes | str) -> None:
    """Write a file that the user named; no list of its folder gets it.

    Raises WriteError, also for a link: `/dev/stdout` is one, and a rename would put a file in its place.
    """
    with writing(path):
        if path.is_symlink():
            raise FileExistsError(errno.EEXIST, "is a link, and not replaced by a file")
    write(path.parent, path.name, content, listed=False)


def write_all(contents: Mapping[Path, bytes | str]) -> None:
    """Write files that the user named, and make their folders.

    Raises WriteError where one cannot be written; what was new of those before it is removed.
    """
    with ExitStack() as undo:
        for path, content in contents.items():
            undo.callback(remove_empty, make_folder(path.parent, target=path))
            is_new = not os.path.lexists(path)
            write_to(path, content)
            if is_new:
                undo.callback(path.unlink, missing_ok=True)
        undo.pop_all()


def require_place(path: Path) -> None:
    """Raise WriteError where a file that the user named cannot be: beside a folder, or in place of one."""
    with writing(path):
        if not stat.S_ISDIR(path.parent.stat().st_mode):
            raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))


def append(path: Path, text: str) -> None:
    """Append to a file that the user named. Raises OSError."""
    with path.open("a", encoding="utf-8") as file:
        file.write(text)


def make_folder(folder: Path, mode: int = 0o777, *, target: Path | None = None) -> list[Path]:
    """Make a folder that the user named, and return those that were missing, outermost first.

    Raises WriteError of it, or of the `target` that it is made for.
    """
    with writing(target or folder):
        missing = [path for path in (folder, *folder.parents) if not path.exists()][::-1]
        for path in missing:
            path.mkdir(mode, exist_ok=True)
        if not folder.is_dir():
            raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
    return missing


def remove_empty(folders: Sequence[Path]) -> None:
    """Remove folders that were made, outermost first, down to one that contains other files by now."""
    with suppress(OSError):
        for folder in reversed(folders):
            folder.rmdir()


def remove(folder: Path, name: str) -> None:
    """Remove a file of uictest, which its name tells, below a folder that the user named. Raises OSError."""
    path = path_below(folder, PurePath(name).parent.as_posix()) / PurePath(name).name
    path.unlink(missing_ok=True)


def remove_partial_files(folder: Path, below: str = "") -> None:
    """Remove files that interrupted writers left in a folder where nobody writes now. Raises OSError."""
    for path in path_below(folder, below).iterdir():
        if is_partial(path):
            path.unlink()


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """Lend a folder that is removed at the end of the block. Raises OSError."""
    with tempfile.TemporaryDirectory(prefix="uictest-") as folder:
        yield Path(folder)


def new_temporary_folder(kind: str) -> Path:
    """Return a new folder, which `remove_temporary_folder` removes. Raises OSError."""
    return Path(tempfile.mkdtemp(prefix=f"uictest-{kind}-"))


def remove_temporary_folder(folder: Path) -> None:
    """Remove a folder of `new_temporary_folder` as far as possible."""
    shutil.rmtree(folder, ignore_errors=True)
