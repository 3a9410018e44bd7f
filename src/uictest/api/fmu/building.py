"""Build FMUs: a C compiler that can link, the shared library, the archive."""

from __future__ import annotations

import hashlib
import io
import os
import platform
import shutil
import subprocess
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from uictest.api.fmu.description import FmiVersion, Model, model_description
from uictest.core import files

SOURCES: Final = Path(__file__).parent / "source"
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
    found = platform.system(), platform.machine()
    if found != ("Linux", "x86_64"):
        raise CannotBuildError(f"an FMU is built on Linux x86_64, this machine is {' '.join(found)}")
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


_FOLDERS: Final = {2: "binaries/linux64", 3: "binaries/x86_64-linux"}
_NO_DATE: Final = (1980, 1, 1, 0, 0, 0)
"""The first that a ZIP archive can hold: the same content gives the same file on every day."""


def token_of(*contents: bytes) -> str:
    """Return a GUID that only these contents have."""
    digits = hashlib.sha256(b"".join(contents)).hexdigest()
    return "{" + "-".join((digits[:8], digits[8:12], digits[12:16], digits[16:20], digits[20:32])) + "}"


def archive_of(
    model: Model,
    version: FmiVersion,
    compiler: str,
    *,
    sources: Sequence[str],
    generated: Mapping[str, bytes],
    inputs: Sequence[str] = (),
    beside: Mapping[str, bytes] | None = None,
    others: Mapping[str, bytes] | None = None,
) -> bytes:
    """Return the file of an FMU. Raises RuntimeError with the compiler's message where it failed.

    Args:
        model: what its description says.
        version: of FMI.
        compiler: as :func:`usable_compiler` gives it.
        sources: files of this package that are compiled, besides those of FMI.
        generated: headers and object files for them.
        inputs: what is linked besides: object files, libraries.
        beside: files that lie beside the shared library, by name.
        others: other files of the archive, by path.
    """
    own = (f"fmi{version}.c", "instance.c", *sources)
    contents = {name: (SOURCES / name).read_bytes() for name in (*own, "instance.h")}
    library = link(compiler, {**contents, **generated}, (*own, *inputs, "-lm"))
    folder = _FOLDERS[version]
    return _archive(
        {
            "modelDescription.xml": model_description(model, version),
            f"{folder}/{model.identifier}.so": library,
            **{f"{folder}/{name}": content for name, content in (beside or {}).items()},
            **(others or {}),
        }
    )


def _archive(files: Mapping[str, bytes]) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(zipfile.ZipInfo(name, _NO_DATE), data, zipfile.ZIP_DEFLATED)
    return content.getvalue()
