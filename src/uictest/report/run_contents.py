"""A finished run read back from its folder."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

from uictest.core import recording
from uictest.judging import evaluation
from uictest.judging.series import series_results_of
from uictest.report.content import RunContent, drawn_cases
from uictest.report.document import read_baseline_comparison, read_subjects
from uictest.report.manifest import read_manifest
from uictest.report.run_report import RESULTS, recording_path, require_names
from uictest.report.traces.trace import PlotTrace, trace_of


def read_run(folder: Path, *, traces: bool = False) -> RunContent:
    """Return what a run folder holds; with `traces`, what a page draws from its recordings, too.

    Raises:
        OSError: results.json or a recording cannot be read.
        ValueError: one of them is not what it should be.

    """
    path = folder / RESULTS
    try:
        content = run_content(json.loads(path.read_text(encoding="utf-8")), folder.resolve().name)
    except (ValueError, RecursionError) as error:  # RecursionError: nested deeper than JSON is read
        raise ValueError(f"{path}: not the results of a run: {error}") from error
    return with_recorded_traces(content, folder) if traces else content


def with_recorded_traces(content: RunContent, folder: Path, chosen: Collection[str] = ()) -> RunContent:
    """Return a run with what a page draws from the recordings in its folder; `chosen` cases first, by id.

    Raises OSError, and ValueError where a recording is none.
    """
    recorded = [result for result in content.all_results if recording_path(folder, result.id).is_file()]
    traces = read_traces(folder, drawn_cases(recorded, chosen))
    return dataclasses.replace(content, traces=traces, drawn_first=chosen)


def run_content(document: object, name: str) -> RunContent:
    """Return what a results document holds, nothing to draw. Raises ValueError where it is none."""
    if not isinstance(document, Mapping):
        raise ValueError(f"expected a JSON object, found {type(document).__name__}")
    try:
        results = evaluation.results_of(document)
        subjects = read_subjects(document)
        manifest = read_manifest(document)
        baseline = read_baseline_comparison(document)
        series = series_results_of(document["series"]) if "series" in document else []
    except (AttributeError, TypeError) as error:
        raise ValueError(str(error)) from error
    complete = document.get("complete", True)
    if not isinstance(complete, bool):
        raise ValueError(f"'complete' must be true or false, found {complete!r}")
    content = RunContent(name, results, manifest, complete, subjects, baseline=baseline, series=series)
    require_names(result.id for result in content.all_results)
    return content


def read_traces(folder: Path, results: Iterable[evaluation.CaseResult]) -> dict[str, PlotTrace]:
    """Return what there is to draw of the cases that have a recording in the folder, by id.

    Raises OSError, and ValueError where a recording is none.
    """
    return {
        result.id: trace_of(recording.read_parquet(path), result.drawn_stop.criteria)
        for result in results
        if (path := recording_path(folder, result.id)).is_file()
    }
