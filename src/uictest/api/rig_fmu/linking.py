"""Link machine code and the functions of FMI into a shared library, with the C compiler of the machine."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from uictest.core import files

_SOURCES: Final = Path(__file__).parent / "source"
_FLAGS: Final = (
    *("-std=gnu11", "-O2", "-fPIC", "-fvisibility=hidden", "-fno-strict-aliasing", "-Wall", "-Wextra"),
    # Nothing is left to be found elsewhere, nothing is built in that names this machine.
    *("-shared", "-Wl,-z,defs", "-Wl,-z,noexecstack", "-Wl,--build-id=none", "-s"),
)
_TRIAL: Final = "#include <string.h>\nsize_t trial(const char *text) { return strlen(text); }\n"


class CannotBuildError(Exception):
    """The machine cannot build an FMU; the message says what is missing."""


def usable_compiler() -> str:
    """Return the path of a C compiler that can link a shared library. Raises CannotBuildError."""
    _require_platform()
    names = [os.environ["CC"]] if os.environ.get("CC") else ["cc", "gcc", "clang"]
    compiler = next((path for name in names if (path := shutil.which(name))), None)
    if compiler is None:
        raise CannotBuildError(
            f"no C compiler ({' or '.join(names)}): install gcc or clang, or name one in the variable CC"
        )
    try:
        link(compiler, {"trial.c": _TRIAL.encode()}, ["trial.c"])
    except RuntimeError as error:
        raise CannotBuildError(f"{compiler} cannot link a shared library: {error}") from error
    return compiler


def _require_platform() -> None:
    found = platform.system(), platform.machine()
    if found != ("Linux", "x86_64"):
        raise CannotBuildError(f"an FMU is built on Linux x86_64, this machine is {' '.join(found)}")


def library(compiler: str, fmi_source: str, case_header: str, code: bytes) -> bytes:
    """Return the shared library of an FMU.

    Args:
        compiler: its path.
        fmi_source: `fmi2.c` or `fmi3.c`.
        case_header: content of `case.h`.
        code: the rig as an object file.

    Raises RuntimeError with what the compiler says.
    """
    sources = {name: (_SOURCES / name).read_bytes() for name in ("rig.h", "rig.c", fmi_source)}
    sources |= {"case.h": case_header.encode(), "code.o": code}
    return link(compiler, sources, [fmi_source, "rig.c", "code.o", "-lm"])


def link(compiler: str, sources: Mapping[str, bytes], inputs: Sequence[str]) -> bytes:
    """Return the shared library made of some of these files. Raises RuntimeError."""
    with files.temporary_folder() as folder:
        for name, content in sources.items():
            files.write(folder, name, content)
        command = [compiler, *_FLAGS, "-o", "library.so", *inputs]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(done.stderr.strip() or f"exit code {done.returncode}")
        return (folder / "library.so").read_bytes()
