"""A finished sweep in its folder: written and read back."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from uictest.core import files
from uictest.judging import evaluation
from uictest.report.junit import WITH_TEST_PROPERTIES, junit_text
from uictest.report.run_folder import read_traces, require_names
from uictest.report.sweep.result import SweepResult, read_sweep_document, sweep_document
from uictest.report.sweep.sweep_sentences import sweep_suite
from uictest.report.sweep.tables import sweep_tables
from uictest.report.text_tables import csv_text
from uictest.report.traces.trace import PlotTrace


@dataclass(frozen=True, slots=True)
class SweepContent:
    """What a report of a sweep shows.

    Args:
        folder: of the sweep; it holds the tables.
        result: what `sweep.json` holds.
        manifest: where the results come from.
        traces: what there is to draw of the worst cases, by id.

    """

    folder: Path
    result: SweepResult
    manifest: Mapping[str, Any]
    traces: Mapping[str, PlotTrace] = field(default_factory=dict)


SWEEP_RESULTS: Final = "sweep.json"
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


OF_ONE_RESULT: Final = (
    *("map-*.csv", "sensitivity.csv", "frontier.csv", "firmness.csv"),
    *(WITH_TEST_PROPERTIES, "index.html", "report.xlsx", "summary.md"),
)
"""Files that not every result has, or that not every run writes."""


def write_sweep_result(folder: Path, result: SweepResult, file: str) -> str:
    """Write everything but the summary of cases, and return the text of `sweep.json`.

    What an earlier, other result of the sweep left in the folder is removed: beside the new one it would lie.
    `file` is the sweep file as shown to users. Raises OSError.
    """
    document = evaluation.to_json(sweep_document(result))
    texts = {f"{name}.csv": csv_text(*table) for name, table in sweep_tables(result).items()}
    texts[SWEEP_RESULTS] = document
    texts["junit.xml"] = junit_text([sweep_suite(result, file)])
    if result.requirements or result.test_case:
        texts[WITH_TEST_PROPERTIES] = junit_text([sweep_suite(result, file, with_properties=True)])
    if (folder / SWEEP_RESULTS).is_file() and (folder / SWEEP_RESULTS).read_text("utf-8") != document:
        files.remove_listed(folder, *OF_ONE_RESULT)
    for name, text in texts.items():
        files.write(folder, name, text)
    return document
