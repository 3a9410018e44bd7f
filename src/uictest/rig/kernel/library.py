"""The kernel: its library found, checked, built in a checkout, and loaded; its functions called.

Libraries are made by kernel/build.py from the package's Python files. The name of one has the digest of the
files that it was made from, that of the programs that made it, and that of its own content: code that is not
of these sources, or damaged, is never run.
"""

import ctypes
import hashlib
import importlib
import importlib.util
import os
import platform
import shlex
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any, Final, NamedTuple

from uictest.rig.kernel.arguments import Arguments, digest_of_layouts, leaves, lengths, passed

PACKAGE: Final = Path(__file__).parents[2]
BUILDER: Final = PACKAGE.parents[1] / "kernel"
"""The programs that make the libraries; only a checkout has them."""
_DIGITS: Final = 12
_SOURCES: Final = (
    *("core/record.py", "core/physics", "core/rail_laws", "controllers", "rig", "api/fmu/resource.py"),
    *("plans/faults.py", "plans/scenario/parts/compensation.py"),
    *(f"core/measures/{name}.py" for name in ("records", "train", "wheelset", "samples")),
)
"""Files and rooms of the package that the kernel and the libraries of FMUs are made from."""


_TURN: Final = threading.Lock()
"""Threads begin their stops at once: one builds, the others wait."""


class KernelError(OSError):
    """No machine code can be run; the message gives the reason and a remedy."""


class Built(NamedTuple):
    """A library that kernel/build.py builds from the Python files of the package.

    Attributes:
        folder: where it lies.
        name: begins its name.
        suffix: of its name.
        options: of the program, with which it builds this one.
        about: what it is, for people.
        system: what it is for, likewise.
    """

    folder: Path
    name: str
    suffix: str
    options: tuple[str, ...]
    about: str
    system: str

    def path(self) -> Path:
        """Return the file, which a checkout builds where its sources have changed. Raises KernelError."""
        with _TURN:
            path = self.fitting()
            if path is None and _is_checkout():
                path = self._built()
        if path is None:
            remedy = "reinstall uictest from its wheel or sources: pip install --force-reinstall PATH"
            raise KernelError(f"{self._why_none_fits()}; {remedy}")
        return path

    def fitting(self) -> Path | None:
        """Return the library of these sources, if it is there as it was built."""
        for path, digests in self._files_with_digests():
            if _are_of_the_sources(digests) and digests[-1] == digest_of(path.read_bytes()):
                return path
        return None

    def _files_with_digests(self) -> list[tuple[Path, list[str]]]:
        paths = self.folder.glob(f"{self.name}-*.{self.suffix}")
        return [
            (path, path.stem.removeprefix(f"{self.name}-").split("-")) for path in paths if path.is_file()
        ]

    def _why_none_fits(self) -> str:
        files = self._files_with_digests()
        fitting = [path for path, digests in files if _are_of_the_sources(digests)]
        if fitting:
            return f"{fitting[0]} is damaged"
        if files:
            places = f"{PACKAGE} and {BUILDER}" if _is_checkout() else PACKAGE
            return f"the files in {places} are not those that {files[0][0]} was built from"
        return f"{self.folder} has no machine code for {self.system}"

    def _built(self) -> Path:
        program = (str(BUILDER / "build.py"), *self.options)
        if importlib.util.find_spec("ziglang") is None:
            remedy = shlex.join(["pip", "install", "--editable", f"{BUILDER.parent}[build]"])
            raise KernelError(f"{self._why_none_fits()}; build it: {remedy}")
        began = time.monotonic()
        sys.stderr.write(f"uictest: building {self.about} ...")
        sys.stderr.flush()
        done = subprocess.run([sys.executable, *program], capture_output=True, text=True, check=False)
        sys.stderr.write(f" {time.monotonic() - began:.1f} s\n")
        if done.returncode != 0:
            raise KernelError(f"{self.about} cannot be built:\n{done.stderr.strip()}")
        path = self.fitting()
        if path is None:
            raise KernelError(f"the sources of {self.about} were changed meanwhile; start again")
        return path


def _is_checkout() -> bool:
    return (BUILDER / "build.py").exists()  # beside an installed package, too, a folder may have this name


def _are_of_the_sources(digests: Sequence[str]) -> bool:
    """Whether the first of the digests in a name are those of the files that are there."""
    return digests[0] == source_digest() and (not _is_checkout() or digests[1] == builder_digest())


@cache
def source_digest() -> str:
    """Return the digest of the Python files that the kernel is made from."""
    return _digest_of_files(sources())


@cache
def builder_digest() -> str:
    """Return the digest of the programs that make the kernel."""
    return _digest_of_files(each for each in _files_in(BUILDER) if each.endswith((".py", ".hpp", ".c")))


def sources() -> Iterator[str]:
    """Yield the Python files that the kernel is made from, everywhere in the same order."""
    for name in _SOURCES:
        path = PACKAGE / name
        yield from (
            [str(path)] if path.suffix else (each for each in _files_in(path) if each.endswith(".py"))
        )


def _files_in(folder: Path) -> Iterator[str]:
    with os.scandir(folder) as entries:
        found = sorted((entry.name, entry.path, entry.is_dir()) for entry in entries)
    for name, path, is_folder in found:
        if not is_folder:
            yield path
        elif name != "__pycache__":
            yield from _files_in(Path(path))


def _digest_of_files(paths: Iterator[str]) -> str:
    digest = hashlib.sha256()
    for path in paths:
        with open(path, "rb") as file:  # noqa: PTH123 - every start reads them all
            digest.update(os.path.basename(path).encode())  # noqa: PTH119
            digest.update(hashlib.sha256(file.read()).digest())
    return digest.hexdigest()[:_DIGITS]


def digest_of(content: bytes) -> str:
    """Return the digest of a file as names of libraries have it."""
    return hashlib.sha256(content).hexdigest()[:_DIGITS]


FOLDER: Final = Path(__file__).parent
SUFFIX: Final = {"win32": "dll", "darwin": "dylib"}.get(sys.platform, "so")
WIDTHS: Final = {"v1": 2, "v3": 4, "v4": 8}
"""Numbers in a register, by the level of x86-64 that the code is for; other processors have v1 only."""
RIG: Final = Built(FOLDER, "rig", SUFFIX, (), "the kernel", f"{platform.system()} {platform.machine()}")
PROCESSOR: Final = "UICTEST_PROCESSOR"
"""Variable that names one of these levels in place of the processor's own."""


class Entry(NamedTuple):
    """A function of the kernel that Python calls.

    Attributes:
        function: where its formula stands, as ``module:function``.
        arguments: what it takes.
    """

    function: str
    arguments: Arguments

    @property
    def symbol(self) -> str:
        """Its name in the library, without that of the processor; it has the digest of what it takes."""
        return f"uictest_{self.function.partition(':')[2]}_{digest_of_layouts(self.arguments)}"

    def target(self) -> Any:
        """Return the Python function."""
        module, _, name = self.function.partition(":")
        return getattr(importlib.import_module(module), name)


def native_function(entry: Entry, level: str | None = None) -> Callable[..., int]:
    """Return a function of the kernel.

    It is called with what its arguments describe: arrays, records, named tuples of them, whole numbers. It
    releases the interpreter's lock while it runs, and raises TypeError where an array or a record does not
    have the compiled layout or shape. Arguments as for :func:`function_of_addresses`.
    """
    function = function_of_addresses(entry, level)
    return lambda *values: function(*passed(entry.arguments, values))


@cache
def function_of_addresses(entry: Entry, level: str | None = None) -> Callable[..., int]:
    """Return the same function, to be called with what :func:`.passed` returns. Raises KernelError.

    Args:
        entry: the function.
        level: of the processor that its code is for; None: the highest that this one has.
    """
    count = len(lengths(entry.arguments)) + sum(1 for _ in leaves(entry.arguments))
    prototype = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_int64] * count)
    try:
        return prototype((f"{entry.symbol}_{level or processor()}", _library()))
    except AttributeError:  # code for other records would write beyond these
        changed = "the records of the rig were changed after this process had loaded them; start it again"
        raise KernelError(changed) from None


def register_width() -> int:
    """Return the number of double-precision numbers in a register of this processor."""
    return WIDTHS[processor()]


@cache
def processor() -> str:
    """Return the level of the processor whose code is run. Raises KernelError."""
    named = os.environ.get(PROCESSOR) or processors()[-1]
    if named not in processors():
        raise KernelError(f"{PROCESSOR}={named}: this processor runs {', '.join(processors())}")
    return named


@cache
def processors() -> tuple[str, ...]:
    """Return the levels whose code this processor can run."""
    best: int = _library().uictest_processor()
    return tuple(level for level in WIDTHS if int(level[1:]) <= best)


@cache
def _library() -> Any:
    path = RIG.path()
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        raise KernelError(f"{path} cannot be loaded on {platform.platform()}: {error}") from error
