"""The archive of an FMU: libraries that are the same in all, and the files that say what this one is of.

kernel/fmu.py builds the libraries, one for each system. Beside them a controller in C is compiled here.
"""

from __future__ import annotations

import hashlib
import importlib.util
import io
import os
import platform
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Final, NamedTuple

from uictest import rig
from uictest.api.fmu.description import FmiVersion, Model, model_description
from uictest.api.fmu.resource import FILE_NAME, Content
from uictest.controllers import HEADER
from uictest.core import files
from uictest.rig import Built

FOLDER: Final = Path(__file__).parent / "binaries"


class System(NamedTuple):
    """A system that an FMU runs on.

    Attributes:
        folder_2: name of its folder in an FMU of FMI 2.0.
        folder: in one of FMI 3.0, and wherever the choice is ours.
        suffix: of a shared library.
    """

    folder_2: str
    folder: str
    suffix: str


SYSTEMS: Final = {
    "linux-x86_64": System("linux64", "x86_64-linux", "so"),
    "windows-x86_64": System("win64", "x86_64-windows", "dll"),
    "linux-aarch64": System("aarch64-linux", "aarch64-linux", "so"),
}
"""By the names that kernel/build.py has for them."""


@cache
def library_of(name: str) -> Path:
    """Return the library for a system. Raises KernelError where there is none that fits this package."""
    about = "the libraries of FMUs"
    return Built(FOLDER, f"fmu-{name}", SYSTEMS[name].suffix, ("--fmus",), about, name).path()


_FLAGS: Final = (
    *(
        "-std=gnu11",
        "-O2",
        "-ffp-contract=off",
        "-fvisibility=hidden",
        "-fno-strict-aliasing",
        "-Wall",
        "-Wextra",
    ),
    *("-shared", "-s"),
)
_ON_LINUX: Final = ("-fPIC", "-Wl,-z,defs", "-Wl,-z,noexecstack", "-Wl,--build-id=none")
"""Nothing is left to be found elsewhere, nothing is built in that names this machine."""
_ZIG: Final = {
    "linux-x86_64": "x86_64-linux-gnu.2.17",
    "windows-x86_64": "x86_64-windows-gnu",
    "linux-aarch64": "aarch64-linux-gnu.2.17",
}
"""System -> its name for `zig cc`, with a C library that old systems have."""
_ARCHITECTURES: Final = {"amd64": "x86_64", "arm64": "aarch64"}


class CannotBuildError(Exception):
    """The machine cannot build an FMU; the message says what is missing."""


def this_system() -> str:
    """Return the name of this system. Raises CannotBuildError where no FMU is for it."""
    machine = platform.machine().lower()
    name = f"{platform.system().lower()}-{_ARCHITECTURES.get(machine, machine)}"
    if name not in SYSTEMS:
        raise CannotBuildError(
            f"a controller in C is exported on {', '.join(SYSTEMS)}: its parameters are asked here, and this"
            f" machine is {name}"
        )
    return name


def compiled(sources: Sequence[Path]) -> dict[str, bytes]:
    """Return the shared libraries of a controller's C sources by the names of their systems.

    The compiler is the one that CC names; else ziglang, where it is installed, which compiles for all; else
    cc, gcc or clang, which compile for this one.

    Raises:
        CannotBuildError: there is no compiler.
        RuntimeError: the compiler failed; the message is its own.
    """
    here = this_system()
    if not os.environ.get("CC") and importlib.util.find_spec("ziglang") is not None:
        zig = (sys.executable, "-m", "ziglang", "cc", "-target")
        return {name: _linked_library((*zig, _ZIG[name]), name, sources) for name in SYSTEMS}
    return {here: _linked_library((_own_compiler(here),), here, sources)}


def _own_compiler(here: str) -> str:
    names = [os.environ["CC"]] if os.environ.get("CC") else ["cc", "gcc", "clang"]
    paths = (path for name in names if here.startswith("linux") and (path := shutil.which(name)))
    if compiler := next(paths, None):
        return compiler
    raise CannotBuildError(
        f"no C compiler ({' or '.join(names)}): pip install ziglang, which compiles for all systems, or, on"
        " Linux, install gcc or clang, or name a compiler in the variable CC"
    )


def _linked_library(compiler: Sequence[str], system: str, sources: Sequence[Path]) -> bytes:
    paths = [source.resolve() for source in sources]
    folders = dict.fromkeys((*(path.parent for path in paths), HEADER.parent))
    includes = [f"-I{folder}" for folder in folders]
    # An `assert` holds the name of its file: without the folders of this machine.
    names = [f"-ffile-prefix-map={folder}=." for folder in folders]
    system_flags = _ON_LINUX if system.startswith("linux") else ()
    with files.temporary_folder() as folder:
        library = folder / f"controller.{SYSTEMS[system].suffix}"
        command = [
            *compiler,
            *_FLAGS,
            *system_flags,
            *includes,
            *names,
            "-o",
            str(library),
            *map(str, paths),
            "-lm",
        ]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(done.stderr.strip() or f"exit code {done.returncode}")
        return library.read_bytes()


_NO_DATE: Final = (1980, 1, 1, 0, 0, 0)
"""The first that a ZIP archive can hold: the same content gives the same file on every day."""
_UNIX: Final = 3
"""The system that the archive says it was made on, wherever that is."""


def archive_of(
    model: Model,
    version: FmiVersion,
    content: Content,
    others: Mapping[str, bytes],
    systems: Iterable[str] = SYSTEMS,
) -> bytes:
    """Return the file of an FMU, on every machine the same.

    Args:
        model: what its description says; the token is added here.
        version: of FMI.
        content: what its library reads.
        others: other files of the archive, by path.
        systems: those that it is for.

    Raises CannotBuildError where this package has no library of FMUs.
    """
    try:
        libraries = {SYSTEMS[name]: library_of(name) for name in systems}
    except rig.KernelError as error:
        raise CannotBuildError(f"{error}") from error
    code = rig.source_digest()
    parts = (
        *sorted(path.name.encode() for path in libraries.values()),
        *others.values(),
        content.file(model, code),
    )
    model = replace(model, token=_token_of(repr((version, model)).encode(), *parts))
    names = {
        system: f"{system.folder_2 if version == 2 else system.folder}/{model.identifier}.{system.suffix}"
        for system in libraries
    }
    return _zip_archive(
        {
            "modelDescription.xml": model_description(model, version),
            **{f"binaries/{names[system]}": path.read_bytes() for system, path in libraries.items()},
            FILE_NAME: content.file(model, code),
            **others,
        }
    )


def _token_of(*contents: bytes) -> str:
    digits = hashlib.sha256(b"".join(contents)).hexdigest()
    return "{" + "-".join((digits[:8], digits[8:12], digits[12:16], digits[16:20], digits[20:32])) + "}"


def _zip_archive(files: Mapping[str, bytes]) -> bytes:
    content = io.BytesIO()
    # Not compressed: machines have different compressors, which give different bytes.
    with zipfile.ZipFile(content, "w") as archive:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, _NO_DATE)
            entry.create_system, entry.external_attr = _UNIX, 0o644 << 16
            archive.writestr(entry, data)
    return content.getvalue()
