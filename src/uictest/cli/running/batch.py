"""A batch of cases, recorded ones too, shown while it runs, and what follows its published reports."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter

from uictest import report, rig, runs
from uictest.cli.output import message
from uictest.cli.progress import announce_in_process, compilation_shown, progress
from uictest.cli.running.display import Display
from uictest.core import files
from uictest.judging import series
from uictest.plans import scenario
from uictest.running import campaign


class TerminalObserver(runs.Observer):
    """Shows results on stdout with a display; progress, warnings and tracebacks on stderr."""

    def __init__(
        self, display: Display, *, quiet: bool, verbose: bool, in_process: bool, colour: str = "auto"
    ) -> None:
        self._display = display
        self._quiet = quiet
        self._verbose = verbose
        self._in_process = in_process
        self._colour = colour

    @contextmanager
    def simulating(self, cases: Sequence[scenario.Case]) -> Iterator[Callable[[], None]]:
        """Announce what takes long or is dangerous, and show the progress of the stops."""
        foreign = any(case.scenario.controller.program for case in cases)
        announce_in_process(foreign=self._in_process and foreign, quiet=self._quiet)
        with compilation_shown(quiet=self._quiet, colour=self._colour):
            rig.load_stop()
        stops = sum(case.scenario.repeat for case in cases)
        unit = "stops" if stops > len(cases) else "cases"
        with progress(stops, quiet=self._quiet, unit=unit, colour=self._colour) as advance:
            yield advance

    def case(self, run: campaign.CaseRun, differences: Sequence[report.Difference]) -> None:
        """Show a case; with -v, the traceback of its crash, too."""
        self._display.case(run.result, differences)
        if self._verbose and run.traceback:
            message(run.traceback.rstrip())

    def case_of_series(self, run: campaign.CaseRun, differences: Sequence[report.Difference]) -> None:
        """Show a case of a series, which only -v does."""
        if self._verbose:
            self.case(run, differences)

    def series(self, result: series.SeriesResult) -> None:
        """Show a series."""
        self._display.series(result)


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
        files.write_to(path, report.junit_text(report.suites_of_run(content)))


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
