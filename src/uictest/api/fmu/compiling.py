"""Controllers in C for FMUs: the compiler that there is, and the shared libraries that it makes."""

from __future__ import annotations

import importlib.util
import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from uictest.api.fmu.binaries import SYSTEMS
from uictest.controllers import HEADER
from uictest.core import files

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
        return {name: _linked((*zig, _ZIG[name]), name, sources) for name in SYSTEMS}
    return {here: _linked((_own_compiler(here),), here, sources)}


def _own_compiler(here: str) -> str:
    names = [os.environ["CC"]] if os.environ.get("CC") else ["cc", "gcc", "clang"]
    found = (path for name in names if here.startswith("linux") and (path := shutil.which(name)))
    if compiler := next(found, None):
        return compiler
    raise CannotBuildError(
        f"no C compiler ({' or '.join(names)}): pip install ziglang, which compiles for all systems, or, on"
        " Linux, install gcc or clang, or name a compiler in the variable CC"
    )


def _linked(compiler: Sequence[str], system: str, sources: Sequence[Path]) -> bytes:
    paths = [each.resolve() for each in sources]
    folders = dict.fromkeys((*(path.parent for path in paths), HEADER.parent))
    includes = [f"-I{folder}" for folder in folders]
    # An `assert` holds the name of its file: without the folders of this machine.
    names = [f"-ffile-prefix-map={folder}=." for folder in folders]
    own = _ON_LINUX if system.startswith("linux") else ()
    with files.temporary_folder() as folder:
        library = folder / f"controller.{SYSTEMS[system].suffix}"
        command = [*compiler, *_FLAGS, *own, *includes, *names, "-o", str(library), *map(str, paths), "-lm"]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(done.stderr.strip() or f"exit code {done.returncode}")
        return library.read_bytes()
