"""Build the FMU of a case: link machine code and the functions of FMI."""

from __future__ import annotations

import hashlib
import io
import os
import platform
import re
import shutil
import subprocess
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from uictest import rig
from uictest.api.rig_fmu.description import (
    FmiVersion,
    Model,
    documentation,
    model_description,
    provenance,
)
from uictest.api.rig_fmu.variables import case_header
from uictest.core import files
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.rig import bench

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


_TARGET: Final = rig.Target("x86-64-v3", in_library=True)
"""Every x86-64 processor since 2013 (AVX2, FMA, BMI2): FMUs are given to colleagues."""
_FOLDERS: Final = {2: "binaries/linux64", 3: "binaries/x86_64-linux"}
_NO_DATE: Final = (1980, 1, 1, 0, 0, 0)
"""The first that a ZIP archive can hold: the same case gives the same file on every day."""


def build_fmu(case: scenario.Case, version: FmiVersion, compiler: str) -> bytes:
    """Return the FMU of a case as the bytes of its file.

    Args:
        case: the case; its controller plays no part, but its cycle time holds.
        version: of FMI.
        compiler: as :func:`~uictest.api.rig_fmu.usable_compiler` gives it.

    Raises:
        ValueError: the seed of the case is too large for the version.
        RuntimeError: the compiler failed; the message is its own.
    """
    case = bench.identified(case)
    inputs, identifier = rig.assemble(case), re.sub(r"\W", "_", f"rig_{case.scenario.name}")
    header, code = case_header(inputs), rig.stepping_code(_TARGET)
    digits = hashlib.sha256(f"{version} {header}".encode() + code).hexdigest()
    model = Model(
        name=f"rig {case.id}",
        identifier=identifier,
        # A GUID that only this content has.
        token="{" + "-".join((digits[:8], digits[8:12], digits[12:16], digits[16:20], digits[20:32])) + "}",
        description=case.scenario.title or f"Brake rig, case {case.id}",
        cycle_time=float(inputs.parameters["cycle_time"]),
        longest=float(inputs.parameters["cycle_time"]) * int(inputs.parameters["cycles"]),
        seed=int(inputs.parameters["seed"]),
    )
    described = model_description(model, version)
    parts = _parts_inside(case)
    sources = {name: (_SOURCES / name).read_bytes() for name in ("rig.h", "rig.c", f"fmi{version}.c")}
    sources["case.h"] = f'#define TOKEN "{model.token}"\n{header}'.encode()
    sources["code.o"] = code
    shared = link(compiler, sources, [f"fmi{version}.c", "rig.c", "code.o", "-lm"])
    return _archive(
        {
            "modelDescription.xml": described,
            f"{_FOLDERS[version]}/{identifier}.so": shared,
            "documentation/index.html": documentation(case, parts),
            "resources/case.json": provenance(case, parts),
        }
    )


def _parts_inside(case: scenario.Case) -> dict[str, evaluation.EffectivePart]:
    """Return the parts that the FMU holds: the controller stays outside, and nothing is judged."""
    parts = evaluation.EffectiveParts().of(case.scenario)
    outside = ("controller", "criteria", "measures")
    return {role: part for role, part in parts.items() if role.partition(".")[0] not in outside}


def _archive(files: Mapping[str, bytes]) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(zipfile.ZipInfo(name, _NO_DATE), data, zipfile.ZIP_DEFLATED)
    return content.getvalue()
