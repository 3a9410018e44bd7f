"""What the results of a sweep depend on: where two manifests agree, so do the results."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any, Final

from uictest.sweep.selection import Selection

SCHEMA: Final = "uictest/sweep-manifest/1"
_ROOMS: Final = ("physics", "controllers", "measures", "lanes", "rig", "evaluation", "scenario", "sweep")
_PACKAGES: Final = ("uictest", "numpy", "scipy", "numba", "pyarrow")


def sweep_manifest(
    selection: Selection, *, expression: str | None, overrides: Sequence[str], seed: int | None
) -> dict[str, Any]:
    """Return the manifest of a sweep; it holds nothing of the machine."""
    plan = selection.plan
    return {
        "schema": SCHEMA,
        "sweep": plan.name,
        "title": plan.title,
        "file": plan.file,
        "scenario": plan.base.path.as_posix(),
        "case": plan.base.id,
        "cases": selection.size,
        "cases_in_a_part": selection.part_size,
        "selected": expression,
        "set": list(overrides),
        "seed": seed,
        "device": selection.device,
        "parameters": list(plan.keys),
        "inputs": plan.inputs,
        "versions": _versions(),
        "program": program_digest(),
    }


def differences(kept: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[str]:
    """Yield in words what has changed from one manifest to another."""
    for name in dict.fromkeys((*kept, *now)):
        before, after = kept.get(name), now.get(name)
        if before == after:
            continue
        if isinstance(before, Mapping) and isinstance(after, Mapping):
            changed = [key for key in dict.fromkeys((*before, *after)) if before.get(key) != after.get(key)]
            yield f"{name}: {', '.join(changed)}"
        elif name == "program":
            yield "the program itself"
        else:
            yield f"{name}: {before} before, {after} now"


@cache
def program_digest() -> str:
    """Return a digest of the sources that decide what a case comes to."""
    digest = hashlib.sha256()
    package = Path(__file__).parent.parent
    for room in _ROOMS:
        for source in sorted((package / room).rglob("*.py")):
            digest.update(source.relative_to(package).as_posix().encode() + b"\0" + source.read_bytes())
    return digest.hexdigest()[:16]


def _versions() -> dict[str, str]:
    python = ".".join(platform.python_version_tuple()[:2])
    return {"python": python} | {name: metadata.version(name) for name in _PACKAGES}
