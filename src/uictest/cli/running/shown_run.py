"""A run, simulated or recorded, shown while it runs, and what follows its published reports."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from time import perf_counter

from uictest import report, runs
from uictest.cli.output import message
from uictest.cli.running.display import Display
from uictest.core import files
from uictest.running import campaign


def publish_and_show(
    batch: runs.Batch,
    output: Path,
    formats: Sequence[str],
    junit: Path | None,
    display: Display,
) -> runs.Published | None:
    """Run a batch, publish its reports and show them; after an interruption, those of the finished cases.

    Returns None if no case is finished. Raises OSError if the reports cannot be written, and removes those
    that were.
    """
    started = perf_counter()
    published = runs.publish_batch(batch, output, formats, display)
    if published is None:
        message("uictest: interrupted before the first case was finished; there is nothing to report")
        return None
    _append_step_summary(published.content)
    _show_published(published, junit, display)
    if not display.quiet:
        _sum_up(batch, published, perf_counter() - started)
    return published


def _append_step_summary(content: report.RunContent) -> None:
    # The run is published already: a failure to write the summary does not undo it.
    try:
        report.append_step_summary(content)
    except OSError as error:
        message(f"uictest: GITHUB_STEP_SUMMARY cannot be written: {error}")


def _show_published(published: runs.Published, junit: Path | None, display: Display) -> None:
    """Write the file of `--junitxml`, if there is to be one, and show the rest of a run. Raises OSError."""
    content = published.content
    if junit is not None:
        files.write_to(junit, report.junit_text(report.suites_of_run(content)))
    display.end(content, published.document)
    if published.index_problem:
        message(f"uictest: {published.index_problem}")


def _sum_up(batch: runs.Batch, published: runs.Published, seconds: float) -> None:
    content = published.content
    ended = "interrupted, " if published.interrupted else ""
    remaining = len(batch.all_cases) - len(content.all_results)
    not_run = f", {remaining} not run" if remaining else ""
    for notice in report.domain_notices(content.all_results):
        message(f"uictest: {notice}")
    message(f"uictest: {ended}{content.tally}{not_run} in {seconds:.1f} s; reports in {published.place}")


_FORMATS = ("html",)


def judge_and_show(
    batch: runs.Batch,
    request: campaign.RecordingRequest,
    output: Path,
    junit: Path | None,
    display: Display,
) -> runs.Published:
    """Judge recorded stops, publish the reports and show them. Raises OSError."""
    content, recordings = runs.judge_recordings(batch)
    wanted = request.among(recordings, content.all_results)
    published = runs.publish_run(content, wanted, output, _FORMATS)
    for result in published.content.results:
        display.show(result)
    for each in published.content.series:
        display.series(each)
    _show_published(published, junit, display)
    return published


def write_preparation(files: Sequence[runs.RecordedFile]) -> None:
    """Write to stderr how each record was prepared, and its defects."""
    for file in files:
        if file.stop is not None:
            choices = "; ".join(f"{name}: {text}" for name, text in file.stop.choices.items())
            message(f"uictest: {file.path}: {choices}")
        for defect in file.defects:
            message(f"uictest: {file.path}: {defect}")
