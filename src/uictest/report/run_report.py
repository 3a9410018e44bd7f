"""The files of a run folder, written."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any, Final

from uictest.core import files, recording
from uictest.judging import evaluation, series
from uictest.report.content import RunContent
from uictest.report.document import baseline_form, subjects_form
from uictest.report.format_registry import IN_EVERY_RUN, write_formats
from uictest.report.manifest import RunManifest, manifest_digest, manifest_form

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
