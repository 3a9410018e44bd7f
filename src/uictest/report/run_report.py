"""Every file of a run folder, written in one place."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from uictest import evaluation
from uictest.report.baseline import BaselineComparison, baseline_form
from uictest.report.case_description import CaseDescription, subjects_form
from uictest.report.junit import junit_xml
from uictest.report.manifest import digest
from uictest.report.tables import criteria_csv, summary_csv, wheelsets_csv

if TYPE_CHECKING:
    from uictest.recording import Recording

RESULTS = "results.json"
RECORDINGS = "recordings"


def run_name(started: datetime, manifest: Mapping[str, Any]) -> str:
    """Return the name of a run: its start in UTC and a short hash of its manifest."""
    return f"{started.astimezone(UTC):%Y%m%dT%H%M%SZ}-{digest(manifest)}"


def write_reports(
    folder: Path,
    results: Sequence[evaluation.CaseResult],
    manifest: Mapping[str, Any],
    *,
    complete: bool,
    subjects: Mapping[str, CaseDescription] | None = None,
    baseline: BaselineComparison | None = None,
) -> str:
    """Write manifest, tables, results and JUnit into the folder, and return the text of results.json.

    `complete` is False where selected cases are missing from the results; `subjects` says what cases are
    about, by id; `baseline` how the run compares with its baseline. Raises OSError.
    """
    from uictest.recording import write_text_atomic

    header = {"manifest": dict(manifest), "complete": complete, "subjects": subjects_form(subjects or {})}
    if baseline is not None:
        header["baseline"] = baseline_form(baseline)
    document = _encodable(evaluation.to_json(evaluation.result_document(results, **header)))
    texts = {
        "manifest.json": _encodable(evaluation.to_json(dict(manifest))),
        **csv_files(results),
        RESULTS: document,
        "junit.xml": junit_xml(results, baseline),
    }
    for name, text in texts.items():
        write_text_atomic(folder / name, text)
    return document


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


def write_recording(folder: Path, case_id: str, recording: Recording) -> Path:
    """Write the recording of a case, named by its id, below the run folder; return its path.

    Raises OSError.
    """
    from uictest.recording import write_parquet

    path = folder / RECORDINGS / f"{case_id}.parquet"
    path.parent.mkdir(exist_ok=True)
    write_parquet(recording, path)
    return path
