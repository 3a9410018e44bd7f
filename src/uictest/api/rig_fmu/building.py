"""Build the FMU of a case."""

from __future__ import annotations

import hashlib
import io
import re
import zipfile
from collections.abc import Mapping
from typing import Final

from uictest import rig
from uictest.api.rig_fmu.c_data import case_header
from uictest.api.rig_fmu.documentation import documentation, provenance
from uictest.api.rig_fmu.linking import library
from uictest.api.rig_fmu.model_description import FmiVersion, Model, model_description
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.rig import bench

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
    model = Model(
        name=f"rig {case.id}",
        identifier=identifier,
        token=_token(f"{version} {header}".encode() + code),
        description=case.scenario.title or f"Brake rig, case {case.id}",
        cycle_time=float(inputs.parameters["cycle_time"]),
        longest=float(inputs.parameters["cycle_time"]) * int(inputs.parameters["cycles"]),
        seed=int(inputs.parameters["seed"]),
    )
    described = model_description(model, version)
    parts = _parts_inside(case)
    shared = library(compiler, f"fmi{version}.c", f'#define TOKEN "{model.token}"\n{header}', code)
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


def _token(content: bytes) -> str:
    """Return a token in the form of a GUID that only this content has."""
    digits = hashlib.sha256(content).hexdigest()
    return "{" + "-".join((digits[:8], digits[8:12], digits[12:16], digits[16:20], digits[20:32])) + "}"


def _archive(files: Mapping[str, bytes]) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(zipfile.ZipInfo(name, _NO_DATE), data, zipfile.ZIP_DEFLATED)
    return content.getvalue()
