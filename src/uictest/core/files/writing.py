"""Atomic writing: a file appears whole or not at all; temporary folders."""

from __future__ import annotations

import errno
import os
import shutil
import stat
import tempfile
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path, PurePath
from typing import BinaryIO

from uictest.core.files.listing import add_to_list, is_partial, names_in, opened, partial_name


class WriteError(OSError):
    """A file or folder that cannot be written: `filename`. Its text says so, with the reason."""

    def __str__(self) -> str:
        return f"cannot write {self.filename}: {self.strerror}"


@contextmanager
def writing(target: Path, *, only_about: Collection[object] = ()) -> Iterator[None]:
    """Let an error of the system be a WriteError of what the user named, or of a file in it.

    With `only_about`, names of files or None, an error about anything else is left as it is.
    """
    try:
        yield
    except WriteError:
        raise
    except OSError as error:
        if only_about and (error.errno is None or error.filename not in only_about):
            raise
        inside = error.filename and Path(error.filename).is_relative_to(target)
        place = error.filename if inside else target
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
    below, last, temporary = str(PurePath(name).parent), PurePath(name).name, partial_name()
    about = (None, temporary, folder, str(folder), *PurePath(name).parts, name)
    with (
        writing(folder / name, only_about=about),
        _made_folders(folder, below),
        opened(folder, below, make=True) as place,
    ):
        if last in ("", ".."):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), name)
        if not private:
            _require_replaceable(place, last)
        flags, mode = os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o600 if private else 0o666
        descriptor = os.open(temporary, flags, mode, dir_fd=place)
        try:
            # Some writers close what they are given; the descriptor stays open.
            with os.fdopen(os.dup(descriptor), "w+b") as file:
                yield file
            os.fsync(descriptor)
            if listed:
                add_to_list(folder, name, descriptor)
            os.replace(temporary, last, src_dir_fd=place, dst_dir_fd=place)
        except BaseException:
            with suppress(OSError):
                os.unlink(temporary, dir_fd=place)
            raise
        finally:
            os.close(descriptor)


@contextmanager
def _made_folders(folder: Path, below: str) -> Iterator[None]:
    """Remove the folders down to `below` that the block has made, should it raise."""
    names = [str(each) for each in (PurePath(below), *PurePath(below).parents) if str(each) != "."]
    missing = [name for name in names if not os.path.lexists(folder / name)]
    try:
        yield
    except BaseException:
        with suppress(OSError), opened(folder) as place:
            for name in missing:
                os.rmdir(name, dir_fd=place)
        raise


def _require_replaceable(place: int, name: str) -> None:
    """Raise FileExistsError for a device or a pipe: a rename would put a file in the place of `/dev/null`."""
    with suppress(FileNotFoundError):
        mode = os.lstat(name, dir_fd=place).st_mode
        if not (stat.S_ISREG(mode) or stat.S_ISLNK(mode) or stat.S_ISDIR(mode)):
            raise FileExistsError(errno.EEXIST, "no file, and not replaced by one", name)


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
    with writing(path), opened(path.parent):
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
    with opened(folder, str(PurePath(name).parent)) as place, suppress(FileNotFoundError):
        os.unlink(PurePath(name).name, dir_fd=place)


def remove_partial_files(folder: Path, below: str = "") -> None:
    """Remove files that interrupted writers left in a folder where nobody writes now. Raises OSError."""
    with opened(folder, below) as place:
        for name in names_in(place):
            if is_partial(place, name):
                os.unlink(name, dir_fd=place)


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
