"""Every file of a run folder, written in one place."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from uictest import evaluation, recording
from uictest.report.baseline import baseline_form
from uictest.report.case_description import subjects_form
from uictest.report.content import RunContent
from uictest.report.junit import junit_xml
from uictest.report.manifest import RunManifest, digest, manifest_form
from uictest.report.tables import criteria_csv, summary_csv, wheelsets_csv

RESULTS = "results.json"
RECORDINGS = "recordings"


def run_name(started: datetime, manifest: RunManifest) -> str:
    """Return the name of a run: its start in UTC and a short hash of its manifest."""
    return f"{started.astimezone(UTC):%Y%m%dT%H%M%SZ}-{digest(manifest)}"


def write_reports(folder: Path, content: RunContent) -> str:
    """Write manifest, tables, results and JUnit into the folder, and return the text of results.json.

    Raises OSError.
    """
    document = _encodable(evaluation.to_json(_document(content)))
    texts = {
        "manifest.json": _encodable(evaluation.to_json(manifest_form(content.manifest))),
        **csv_files(content.results),
        RESULTS: document,
        "junit.xml": junit_xml(content.results, content.baseline),
    }
    for name, text in texts.items():
        recording.write_text_atomic(folder / name, text)
    return document


def _document(content: RunContent) -> dict[str, Any]:
    header: dict[str, Any] = {
        "manifest": manifest_form(content.manifest),
        "complete": content.complete,
        "subjects": subjects_form(content.subjects),
    }
    if content.baseline is not None:
        header["baseline"] = baseline_form(content.baseline)
    return evaluation.result_document(content.results, **header)


def csv_files(results: Sequence[evaluation.CaseResult]) -> dict[str, str]:
    """Return the three tables under the names of their files."""
    return {
        "summary.csv": summary_csv(results),
        "wheelsets.csv": wheelsets_csv(results),
        "criteria.csv": criteria_csv(results),
    }


def _encodable(json_text: str) -> str:
    # A file name that is no UTF-8 holds lone surrogates; spelled out they are valid JSON escapes.
    return json_text.encode("utf-8", "backslashreplace").decode("utf-8")


def write_recording(folder: Path, case_id: str, samples: recording.Recording) -> Path:
    """Write the recording of a case, named by its id, below the run folder; return its path.

    Raises OSError.
    """
    path = folder / RECORDINGS / f"{case_id}.parquet"
    path.parent.mkdir(exist_ok=True)
    recording.write_parquet(samples, path)
    return path
