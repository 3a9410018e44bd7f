"""A batch of cases, shown while it runs, and what follows its published reports."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from time import perf_counter

from uictest import report, runs
from uictest.cli.output import message
from uictest.cli.running.display import Display
from uictest.cli.running.following import TerminalObserver
from uictest.core import files


def publish_and_show(
    batch: runs.Batch,
    output: Path,
    formats: Sequence[str],
    junit: Path | None,
    display: Display,
    *,
    quiet: bool,
    verbose: bool,
    colour: str = "auto",
) -> runs.Published | None:
    """Run a batch, publish its reports and show them; after an interruption, those of the finished cases.

    Returns None if no case is finished. Raises OSError if the reports cannot be written, and removes those
    that were.
    """
    started = perf_counter()
    observer = TerminalObserver(
        display, quiet=quiet, verbose=verbose, in_process=batch.in_process, colour=colour
    )
    published = runs.publish_batch(batch, output, formats, observer)
    if published is None:
        message("uictest: interrupted before the first case was finished; there is nothing to report")
        return None
    content = published.content
    _append_step_summary(content)
    write_junit(junit, content)
    display.end(content, published.document)
    show_index_problem(published.index_problem)
    if not quiet:
        _sum_up(batch, published, perf_counter() - started)
    return published


def _append_step_summary(content: report.RunContent) -> None:
    # The run is published already: a failure to write the summary does not undo it.
    try:
        report.append_step_summary(content)
    except OSError as error:
        message(f"uictest: GITHUB_STEP_SUMMARY cannot be written: {error}")


def show_index_problem(problem: str) -> None:
    """Show why the index of all runs was not written; nothing if it was."""
    if problem:
        message(f"uictest: {problem}")


def write_junit(path: Path | None, content: report.RunContent) -> None:
    """Write the file of `--junitxml`, if there is to be one. Raises OSError."""
    if path is not None:
        document = report.junit_xml(
            content.results, content.baseline, content.series, uictest_version=content.uictest_version
        )
        files.write_to(path, document)


def _sum_up(batch: runs.Batch, published: runs.Published, seconds: float) -> None:
    content = published.content
    ended = "interrupted, " if published.interrupted else ""
    remaining = len(batch.all_cases) - len(content.all_results)
    not_run = f", {remaining} not run" if remaining else ""
    for notice in report.domain_notices(content.all_results):
        message(f"uictest: {notice}")
    message(f"uictest: {ended}{content.tally}{not_run} in {seconds:.1f} s; reports in {published.place}")
