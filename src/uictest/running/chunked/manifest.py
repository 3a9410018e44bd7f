"""Manifest of a sweep, with everything that its results depend on: equal manifests, equal results."""

from __future__ import annotations

import hashlib
import os
import platform
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any, Final

from uictest.core import document
from uictest.judging.evaluation import EffectiveParts
from uictest.plans import library
from uictest.plans.scenario import SURVEY
from uictest.report import named_parts
from uictest.running.chunked.case_selection import CaseSelection
from uictest.running.chunked.table import SURVEY_TABLE

SOURCES: Final = (*("core", "controllers", "plans", "judging", "rig", "running"),)
"""Rooms and modules of the package that determine the result of a case."""
_PACKAGES: Final = ("uictest", "numpy", "scipy", "numba", "pyarrow")
_LIBRARY: Final = "library:"
_LABELS: Final = {
    "selected": "selection",
    "cases_in_a_part": "cases per chunk",
}
"""Key -> the name that users know it by, where the two differ."""
_DIGESTS: Final = {"program": "the program itself", "cases_sha256": "the cases that the sweep file asks for"}
"""Key of a digest, which itself says nothing -> what it is of."""


def sweep_manifest(
    selection: CaseSelection, *, expression: str | None, overrides: Sequence[str], seed: int | None
) -> dict[str, Any]:
    """Return the manifest of a sweep, which does not depend on the machine.

    Files are named relative to the sweep file, so that the manifest is the same from every working folder;
    but `file`, which people and GitHub look up, is the path that the user gave.
    """
    plan = selection.plan
    folder = Path(plan.file).parent
    return {
        **document.head(document.MANIFEST, "sweep"),
        "sweep": plan.name,
        "title": plan.title,
        "file": plan.file,
        "scenario": _relative_to(folder, plan.base.path.as_posix()),
        "case": plan.base.id,
        "cases": selection.size,
        "cases_in_a_part": selection.chunk_size,
        "selected": expression,
        "set": list(overrides),
        "seed": seed,
        "parameters": list(plan.keys),
        "parts": named_parts([EffectiveParts().of(plan.base.scenario)]),
        "cases_sha256": plan.cases_sha256,
        "inputs": {_relative_to(folder, name): digest for name, digest in plan.inputs.items()},
        **({"time_step": SURVEY} if plan.survey else {}),
        "versions": _versions(),
        "program": program_digest(),
    }


def manifest_differences(
    one: Mapping[str, Any], other: Mapping[str, Any], whose: tuple[str, str] = ("before", "now")
) -> Iterator[str]:
    """Yield the differences of two manifests in words; `whose` names the two manifests.

    The name of the sweep file does not count, and of its content only what says which cases there are; nor do
    the heads of manifests, which 0.2 wrote otherwise.
    """
    for name in dict.fromkeys((*one, *other)):
        first, second = _decisive(one, name), _decisive(other, name)
        if first == second or name in ("file", "schema", "kind"):
            continue
        if isinstance(first, Mapping) and isinstance(second, Mapping):
            yield f"{name}: {', '.join(_changed(first, second))}"
        elif name in _DIGESTS:
            yield _DIGESTS[name]
        else:
            label = _LABELS.get(name, name.replace("_", " "))
            yield f"{label}: {_words(first)} {whose[0]}, {_words(second)} {whose[1]}"


def _decisive(manifest: Mapping[str, Any], name: str) -> Any:
    """Return an entry as far as results depend on it: of the inputs all but the sweep file."""
    entry = manifest.get(name)
    if name != "inputs" or "cases_sha256" not in manifest or not isinstance(entry, Mapping):
        return entry
    return {key: digest for key, digest in entry.items() if key != Path(str(manifest.get("file"))).name}


def _changed(one: Mapping[str, Any], other: Mapping[str, Any]) -> list[str]:
    return [key for key in dict.fromkeys((*one, *other)) if one.get(key) != other.get(key)]


def _words(value: Any) -> str:
    if value is None or value in ("", []):
        return "none"
    if not isinstance(value, list):
        return str(value)
    *others, last = map(str, value)
    return f"{', '.join(others)} and {last}" if others else last


def _relative_to(folder: Path, name: str) -> str:
    if name.startswith(_LIBRARY):
        return name
    try:
        return Path(os.path.relpath(name, folder)).as_posix()
    except ValueError:  # on another drive
        return name


@cache
def program_digest() -> str:
    """Return a digest of the sources that determine the result of a case, and of the biases of a survey."""
    digest = hashlib.sha256(library.table(SURVEY_TABLE).encode())
    package = Path(__file__).parents[2]
    for name in SOURCES:
        place = package / name
        for source in sorted(place.rglob("*.py")) if place.is_dir() else [place]:
            digest.update(source.relative_to(package).as_posix().encode() + b"\0" + source.read_bytes())
    return digest.hexdigest()[:16]


def _versions() -> dict[str, str]:
    python = ".".join(platform.python_version_tuple()[:2])
    return {"python": python} | {name: metadata.version(name) for name in _PACKAGES}
