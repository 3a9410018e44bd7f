"""The files of a run folder: written, and read back."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Collection, Iterable, Mapping
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any, Final

from uictest.core import files, recording
from uictest.judging import evaluation, series
from uictest.judging.series import series_results_of
from uictest.report.content import RunContent, drawn_cases
from uictest.report.document import baseline_form, read_baseline_comparison, read_subjects, subjects_form
from uictest.report.format_registry import IN_EVERY_RUN, write_formats
from uictest.report.manifest import RunManifest, manifest_digest, manifest_form, read_manifest
from uictest.report.traces.trace import PlotTrace, trace_of

RECORDINGS: Final = "recordings"
_ELSEWHERE: Final = ("", ".", "..")


def recording_path(folder: Path, case_id: str) -> Path:
    """Return the path of the recording of a case below the folder of a run.

    Raises ValueError for an id that would lead out of the folder, on any system.
    """
    require_names([case_id])
    return folder / RECORDINGS / f"{case_id}.parquet"


def require_names(case_ids: Iterable[str]) -> None:
    """Raise ValueError for an id that is not the name of a file: a path, on this system or another."""
    for case_id in case_ids:
        if not _is_name(case_id):
            raise ValueError(f"the id {case_id!r} of a case is not the name of a file")


def _is_name(case_id: str) -> bool:
    names = {path(case_id).name for path in (PurePosixPath, PureWindowsPath)}
    return case_id not in _ELSEWHERE and names == {case_id} and "\0" not in case_id


RESULTS = "results.json"


def run_name(started: datetime, manifest: RunManifest) -> str:
    """Return the name of a run: its start in UTC and a short hash of its manifest."""
    return f"{started.astimezone(UTC):%Y%m%dT%H%M%SZ}-{manifest_digest(manifest)}"


def write_reports(folder: Path, content: RunContent) -> str:
    """Write the manifest, the results and the reports of every run; return the text of results.json.

    Raises OSError.
    """
    document = _encodable(evaluation.to_json(_document(content)))
    texts = {
        "manifest.json": _encodable(evaluation.to_json(manifest_form(content.manifest))),
        RESULTS: document,
    }
    for name, text in texts.items():
        files.write(folder, name, text)
    write_formats(folder, content, IN_EVERY_RUN)
    return document


def _document(content: RunContent) -> dict[str, Any]:
    header: dict[str, Any] = {
        "manifest": manifest_form(content.manifest),
        "complete": content.complete,
        "subjects": subjects_form(content.subjects),
    }
    if content.baseline is not None:
        header["baseline"] = baseline_form(content.baseline)
    if content.series:
        header["series"] = series.series_document(content.series)
    return evaluation.result_document(content.results, **header)


def _encodable(json_text: str) -> str:
    # A file name that is no UTF-8 holds lone surrogates; spelled out they are valid JSON escapes.
    return json_text.encode("utf-8", "backslashreplace").decode("utf-8")


def write_recording(folder: Path, case_id: str, samples: recording.Recording) -> Path:
    """Write the recording of a case, named by its id, below the run folder; return its path.

    Raises OSError.
    """
    path = recording_path(folder, case_id)
    files.write(folder, path.relative_to(folder).as_posix(), recording.parquet_bytes(samples))
    return path


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
