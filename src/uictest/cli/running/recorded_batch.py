"""Recorded stops, judged, published and shown."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from uictest import runs
from uictest.cli.output import message
from uictest.cli.running.batch import show_index_problem, write_junit
from uictest.cli.running.display import Display
from uictest.running import campaign

_FORMATS = ("html",)


def judge_and_show(
    batch: runs.RecordedBatch,
    request: campaign.RecordingRequest,
    output: Path,
    junit: Path | None,
    display: Display,
) -> runs.Published:
    """Judge every stop, publish the reports and show them. Raises OSError."""
    judged = runs.judge_recordings(batch)
    published = runs.publish_run(judged.content, judged.wanted(request), output, _FORMATS)
    content = published.content
    write_junit(junit, content)
    for result in content.results:
        display.case(result)
    for each in content.series:
        display.series(each)
    display.end(content, published.document)
    show_index_problem(published.index_problem)
    return published


def write_preparation(files: Sequence[runs.RecordedFile]) -> None:
    """Write to stderr how each record was prepared, and its defects."""
    for file in files:
        if file.stop is not None:
            choices = "; ".join(f"{name}: {text}" for name, text in file.stop.choices.items())
            message(f"uictest: {file.path}: {choices}")
        for defect in file.defects:
            message(f"uictest: {file.path}: {defect}")
