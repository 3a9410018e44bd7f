"""The folder of a run, written and read back: its documents in JSON and its recordings."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Annotated, Any, Final

from pydantic import BeforeValidator, ConfigDict, TypeAdapter

from uictest.core import files, recording
from uictest.judging import evaluation, series
from uictest.report.content import (
    CaseDescription,
    RunContent,
    RunManifest,
    campaign_form,
    drawn_cases,
    manifest_digest,
    manifest_form,
    read_campaign,
    read_manifest,
)
from uictest.report.difference import BaselineComparison, Difference
from uictest.report.traces.trace import PlotTrace, trace_of_stop

RESULTS: Final = "results.json"
RECORDINGS: Final = "recordings"
_CONFIG: Final = ConfigDict(extra="forbid", defer_build=True)


def _with_nan(content: object) -> object:
    """Return the form of a difference with NaN for a side without a number, which is null in JSON."""
    if isinstance(content, Mapping):
        missing = [side for side in ("first", "second") if content.get(side, 0.0) is None]
        return {**content, **dict.fromkeys(missing, math.nan)}
    return content


_DIFFERENCES: Final = TypeAdapter(list[Annotated[Difference, BeforeValidator(_with_nan)]], config=_CONFIG)
_BASELINE: Final = TypeAdapter(list[BaselineComparison], config=_CONFIG)
_SUBJECTS: Final = TypeAdapter(
    dict[str, Annotated[CaseDescription, evaluation.required("title", "tags", "settings")]],
    config=ConfigDict(defer_build=True),
)


def differences_form(differences: Sequence[Difference]) -> list[dict[str, Any]]:
    """Return the JSON form of differences, NaN as None."""
    form: list[dict[str, Any]] = evaluation.json_form(
        evaluation.to_json_form(_DIFFERENCES, list(differences))
    )
    for difference in form:
        if difference["status"] is None:
            del difference["status"]
    return form


def baseline_form(baseline: BaselineComparison) -> dict[str, Any]:
    """Return the JSON form of a comparison: one list of differences, and `agrees` for who needs no more."""
    form: dict[str, Any] = evaluation.to_json_form(_BASELINE, [baseline])[0]
    head = {"folder": baseline.folder, "sha256": baseline.sha256, "agrees": baseline.agrees}
    lists = {"differences": baseline.all_differences, "informing": baseline.informing}
    return head | form | {name: differences_form(differences) for name, differences in lists.items()}


def read_baseline_comparison(document: Mapping[str, Any]) -> BaselineComparison | None:
    """Return the comparison of the run of a document with its baseline; None without one.

    Raises ValueError where the document holds something else.
    """
    content = document.get("baseline")
    if not content:
        return None
    if isinstance(content, Mapping) and isinstance(content.get("differences"), list):
        by_case: dict[str, list[Difference]] = {}
        for difference in evaluation.from_json_form(_DIFFERENCES, content["differences"], place="baseline"):
            by_case.setdefault(difference.case, []).append(difference)
        content = {name: value for name, value in content.items() if name != "agrees"}
        content["differences"] = by_case
        informing = content.get("informing", [])
        content["informing"] = evaluation.from_json_form(_DIFFERENCES, informing, place="baseline")
    return evaluation.from_json_form(_BASELINE, [content], place="baseline")[0]


def subjects_form(subjects: Mapping[str, CaseDescription]) -> dict[str, Any]:
    """Return the JSON form of the subjects of cases, by the ids of the cases."""
    form: dict[str, Any] = evaluation.to_json_form(_SUBJECTS, subjects)
    return form


def run_name(started: datetime, manifest: RunManifest) -> str:
    """Return the name of a run: its start in UTC and a short hash of its manifest."""
    return f"{started.astimezone(UTC):%Y%m%dT%H%M%SZ}-{manifest_digest(manifest)}"


def run_texts(content: RunContent) -> dict[str, str]:
    """Return the documents of a run in JSON, by the names of their files."""
    header: dict[str, Any] = {
        "manifest": manifest_form(content.manifest),
        "complete": content.complete,
        "subjects": subjects_form(content.subjects),
    }
    if content.baseline is not None:
        header["baseline"] = baseline_form(content.baseline)
    if content.series:
        header["series"] = series.series_document(content.series)
    if content.passed_over:
        header["passed_over"] = list(content.passed_over)
    if content.campaign is not None:
        header["campaign"] = campaign_form(content.campaign)
    return {
        "manifest.json": evaluation.to_json(header["manifest"]),
        RESULTS: evaluation.to_json(evaluation.result_document(content.results, **header)),
    }


def recording_path(folder: Path, case_id: str) -> Path:
    """Return the path of the recording of a case below the folder of a run.

    Raises ValueError for an id that would lead out of the folder, on any system.
    """
    require_names([case_id])
    return folder / RECORDINGS / f"{case_id}.parquet"


def require_names(case_ids: Iterable[str]) -> None:
    """Raise ValueError for an id that is not the name of a file: a path, on this system or another."""
    for case_id in case_ids:
        names = {path(case_id).name for path in (PurePosixPath, PureWindowsPath)}
        if case_id in ("", ".", "..") or names != {case_id} or "\0" in case_id:
            raise ValueError(f"the id {case_id!r} of a case is not the name of a file")


def write_recording(folder: Path, case_id: str, samples: recording.Recording) -> Path:
    """Write the recording of a case, named by its id, below the run folder; return its path.

    Raises OSError.
    """
    path = recording_path(folder, case_id)
    files.write(folder, path.relative_to(folder).as_posix(), recording.parquet_bytes(samples))
    return path


def write_controller_log(folder: Path, case_id: str, text: str) -> str:
    """Write what the controller of a case printed, named by its id, below the run folder; return its name.

    Raises OSError.
    """
    require_names([case_id])
    name = f"logs/{case_id}.log"
    files.write(folder, name, text.encode())
    return name


def read_run(folder: Path) -> RunContent:
    """Return the content of a run folder, without drawings.

    Raises OSError, and ValueError where results.json is not what it should be.
    """
    path = folder / RESULTS
    try:
        return run_content(json.loads(path.read_text(encoding="utf-8")), folder.resolve().name)
    except (ValueError, RecursionError) as error:  # RecursionError: nested deeper than JSON is read
        raise ValueError(f"{path}: not the results of a run: {error}") from error


def with_recorded_traces(content: RunContent, folder: Path, drawn_first: Collection[str] = ()) -> RunContent:
    """Return a run with what a page draws from the recordings in its folder.

    Cases `drawn_first`, by id, are drawn before others. Raises OSError, and ValueError where a recording is
    none.
    """
    recorded = [result for result in content.all_results if recording_path(folder, result.id).is_file()]
    traces = read_traces(folder, drawn_cases(recorded, drawn_first))
    return dataclasses.replace(content, traces=traces, drawn_first=drawn_first)


def read_subjects(document: Mapping[str, Any]) -> dict[str, CaseDescription]:
    """Return the subjects of the cases in a document. Raises ValueError where they are none."""
    try:
        return evaluation.from_json_form(_SUBJECTS, document.get("subjects"), place="subjects")
    except ValueError as error:
        raise ValueError(f"not the subject of a case: {error}") from error


def run_content(document: object, name: str) -> RunContent:
    """Return the content of a results document, without drawings. Raises ValueError where it is none."""
    if not isinstance(document, Mapping):
        raise ValueError(f"expected a JSON object, found {type(document).__name__}")
    try:
        results = evaluation.results_of(document)
        subjects = read_subjects(document)
        manifest = read_manifest(document)
        baseline = read_baseline_comparison(document)
        campaign = read_campaign(document)
        judged = series.series_results_of(document["series"]) if "series" in document else []
    except (AttributeError, TypeError) as error:
        raise ValueError(str(error)) from error
    complete = document.get("complete", True)
    if not isinstance(complete, bool):
        raise ValueError(f"'complete' must be true or false, found {complete!r}")
    passed_over = document.get("passed_over", [])
    if not (isinstance(passed_over, list) and all(isinstance(line, str) for line in passed_over)):
        raise ValueError("'passed_over' must be a list of sentences")
    content = RunContent(
        *(name, results, manifest, complete, subjects),
        baseline=baseline,
        series=judged,
        passed_over=passed_over,
        campaign=campaign,
    )
    require_names(result.id for result in content.all_results)
    return content


def read_traces(folder: Path, results: Iterable[evaluation.CaseResult]) -> dict[str, PlotTrace]:
    """Return the traces of the cases that have a recording in the folder, by id.

    Raises OSError, and ValueError where a recording is none.
    """
    return {
        result.id: trace_of_stop(recording.read_parquet(path), result)
        for result in results
        if (path := recording_path(folder, result.id)).is_file()
    }
