"""Atomic writing: a file appears whole or not at all; temporary folders."""

from __future__ import annotations

import errno
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path, PurePath
from typing import BinaryIO

from uictest.core.files.listing import add_to_list, is_partial, partial_name, path_below


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
        place = path if path.is_relative_to(target) and not is_hidden else target
        raise WriteError(error.errno, error.strerror or str(error), str(place)) from error


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
            place = path_below(folder, below)
            folder.stat()  # which is not made
            undo.callback(remove_empty, make_folder(place, target=folder / name))
            if last in ("", ".."):
                raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), name)
            if not private:
                _require_replaceable(place / last)
            temporary = place / partial_name()
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
            temporary.replace(place / last)


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
        missing = [place for place in (folder, *folder.parents) if not place.exists()][::-1]
        for place in missing:
            place.mkdir(mode, exist_ok=True)
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
