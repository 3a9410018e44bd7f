"""A finished sweep read back from its folder."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

from uictest import evaluation
from uictest.report.case_description import read_subjects
from uictest.report.run_contents import read_traces
from uictest.report.sweep.content import SweepContent

SWEEP_RESULTS: Final = "sweep.json"
_MANIFEST: Final = "manifest.json"
_SCHEMA: Final = "uictest/sweep-result/1"
_FINDINGS: Final = (
    *("name", "title", "cases", "met", "outcomes", "missed", "rates", "maps", "distributions"),
    *("trends", "worst", "subjects", "frontier", "sensitivities", "notes"),
)


def read_sweep(folder: Path, *, traces: bool = False) -> SweepContent:
    """Return what a sweep's folder holds; with `traces`, what there is to draw of its worst cases, too.

    Raises:
        OSError: sweep.json, manifest.json or a recording cannot be read.
        ValueError: one of them is not what it should be.

    """
    path = folder / SWEEP_RESULTS
    document = _findings(path)
    try:
        parts = evaluation.parts_of(document)
        worst = evaluation.cases_of(document["worst"], parts, "worst")
        base = {role: parts[part_id] for role, part_id in document.get("base", {}).items()}
        subjects = read_subjects(document)
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise ValueError(f"{path}: not the result of a sweep: {error}") from error
    drawn = read_traces(folder, worst) if traces else {}
    return SweepContent(folder, document, _mapping(folder / _MANIFEST), worst, subjects, drawn, base)


def _findings(path: Path) -> dict[str, Any]:
    document = _mapping(path)
    if document.get("schema") != _SCHEMA or any(name not in document for name in _FINDINGS):
        raise ValueError(f"{path}: not the result of a sweep")
    return document


def _mapping(path: Path) -> dict[str, Any]:
    try:
        content = json.loads(path.read_bytes())
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error
    if not isinstance(content, dict):
        raise ValueError(f"{path}: not the result of a sweep")
    return content
