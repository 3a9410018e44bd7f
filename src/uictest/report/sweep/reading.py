"""Read a finished sweep from its folder."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

from uictest.report.recording_path import require_names
from uictest.report.run_contents import read_traces
from uictest.report.sweep.content import SweepContent
from uictest.report.sweep.result import read_sweep_document

SWEEP_RESULTS: Final = "sweep.json"
SWEEP_MANIFEST_SCHEMA: Final = "uictest/sweep-manifest/1"
_MANIFEST: Final = "manifest.json"


def read_sweep(folder: Path, *, traces: bool = False) -> SweepContent:
    """Return the sweep in a folder; with `traces`, what there is to draw of its worst cases, too.

    Raises:
        OSError: sweep.json, manifest.json or a recording cannot be read.
        ValueError: one of them is not what it should be.

    """
    path = folder / SWEEP_RESULTS
    try:
        result = read_sweep_document(_read_mapping(path))
        require_names(case.id for case in result.worst)
    except ValueError as error:
        raise ValueError(f"{path}: not the result of a sweep: {error}") from error
    drawn = read_traces(folder, result.worst) if traces else {}
    return SweepContent(folder, result, _read_manifest(folder / _MANIFEST), drawn)


def _read_manifest(path: Path) -> dict[str, Any]:
    try:
        return _read_mapping(path)
    except ValueError as error:
        raise ValueError(f"{path}: not the manifest of a sweep: {error}") from error


def _read_mapping(path: Path) -> dict[str, Any]:
    try:
        content = json.loads(path.read_bytes())
    except RecursionError as error:  # nested deeper than JSON is read
        raise ValueError(str(error)) from error
    if not isinstance(content, dict):
        raise ValueError("expected an object")
    return content
