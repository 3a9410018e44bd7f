"""Run a sweep, show it while it runs, and return its exit code."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator
from contextlib import AbstractContextManager
from pathlib import Path
from time import monotonic, perf_counter

from uictest import report, runs
from uictest.cli import progress as steps
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import Format
from uictest.cli.output import interactive, message
from uictest.cli.progress import Advance, TerminalObserver
from uictest.cli.sweep.display import show_annotations, show_result
from uictest.core import files
from uictest.report import counted
from uictest.running import chunked
from uictest.runs import history


@contextlib.contextmanager
def sweep_progress(total: int, done: int, *, quiet: bool) -> Iterator[Advance]:
    """Lend a function that counts finished cases; `done` of `total` were finished before."""
    if quiet:
        yield lambda cases: None
    elif interactive(sys.stderr):
        with _bar(total, done) as advance:
            yield advance
    else:
        yield _Heartbeat(total, done).advance


@contextlib.contextmanager
def _bar(total: int, done: int) -> Iterator[Advance]:
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        ProgressColumn,
        Task,
        TimeRemainingColumn,
    )
    from rich.text import Text

    class Rate(ProgressColumn):
        def render(self, task: Task) -> Text:
            return Text("-" if task.speed is None else f"{task.speed:.0f} cases/s")

    columns = (BarColumn(), MofNCompleteColumn(), Rate(), TimeRemainingColumn())
    console = steps.error_console()
    with Progress(*columns, console=console, transient=True, speed_estimate_period=60.0) as bar:
        task = bar.add_task("simulating", total=total, completed=done)
        yield lambda cases: bar.advance(task, cases)


class _Heartbeat:
    """A line when a chunk is finished, unless the last line is recent."""

    def __init__(self, total: int, done: int) -> None:
        self._total, self._before, self._done = total, done, 0
        self._started = self._last_line = monotonic()

    def advance(self, cases: int) -> None:
        """Count finished cases, and print a line if the last one is old enough."""
        self._done += cases
        now = monotonic()
        if now - self._last_line >= steps.HEARTBEAT:
            self._last_line = now
            message(self._line(now - self._started))

    def _line(self, seconds: float) -> str:
        rate = self._done / seconds
        finished = self._before + self._done
        remaining = (self._total - finished) / rate
        return f"uictest: {finished} of {self._total} cases, {rate:.0f} cases/s, {remaining:.0f} s left"


class SweepObserver(TerminalObserver):
    """Writes messages and progress to stderr; if `quiet`, only what went wrong or was asked for.

    `merging` says whether the chunks of shards are merged.
    """

    def __init__(self, *, quiet: bool, merging: bool) -> None:
        super().__init__(quiet=quiet)
        self._merging = merging

    def damaged(self, chunk: Path) -> None:
        """Report a damaged chunk."""
        message(f"uictest: {chunk} is damaged: recomputing this chunk")

    def damaged_in_shard(self, chunk: Path) -> None:
        """Report a damaged chunk of a shard."""
        message(f"uictest: {chunk} is damaged: skipped")

    def merged(self, chunks: int, shard: Path) -> None:
        """Report what a shard brought."""
        message(f"uictest: {counted(chunks, 'chunk')} from {shard}")

    def found(self, cases: int, missing: int) -> None:
        """Report how many cases are already finished, or how many no shard provided."""
        if self._merging and missing:
            verb = "is" if missing == 1 else "are"
            pronoun = "it" if missing == 1 else "them"
            message(
                f"uictest: {missing} of {counted(cases, 'case')} {verb} missing from the shards: "
                f"simulating {pronoun} here"
            )
        elif missing < cases and not self.quiet:
            message(f"uictest: {cases - missing} of {counted(cases, 'case')} are already finished")

    def simulating(
        self, count: int, finished: int = 0, unit: str = "cases"
    ) -> AbstractContextManager[Advance]:
        """Show the progress of the cases."""
        return sweep_progress(count, finished, quiet=self.quiet)

    def waiting(self, address: str) -> None:
        """Report that a cluster has no workers yet."""
        message(f"uictest: waiting for workers at {address}")

    def searching(self, key: str) -> None:
        """Report that the frontier is being searched."""
        if not self.quiet:
            message(f"uictest: searching the frontier along {key}")


def execute_sweep(run: runs.SweepRun, shown: Format, junit: Path | None, *, quiet: bool) -> ExitCode:
    """Run a sweep and show its result; return its exit code. Raises InvalidInputError, OSError."""
    try:
        return _run_and_show(run, shown, junit, quiet=quiet)
    except runs.MaxfailReached as reached:
        message(f"uictest: stopped at --maxfail: {reached}")
        message(
            f"uictest: finished chunks are kept in {run.folder}; the same command without --maxfail continues"
        )
        return ExitCode.MISSED
    except KeyboardInterrupt:
        message("uictest: interrupted")
        _report_finished_chunks(run)
        return ExitCode.INTERRUPTED
    except OSError:
        _report_finished_chunks(run)
        raise


def _run_and_show(run: runs.SweepRun, shown: Format, junit: Path | None, *, quiet: bool) -> ExitCode:
    started = perf_counter()
    finished = runs.run_sweep(run, SweepObserver(quiet=quiet, merging=bool(run.merged)))
    if finished is None:
        message(f"uictest: {_shard_words(run)}")
        return ExitCode.MET
    if problem := history.refresh_index(run.folder.parent):
        message(f"uictest: {problem}")
    _append_step_summary(finished.content)
    if junit is not None:
        suite = report.sweep_suite(finished.result, run.selection.plan.file)
        files.write_to(junit, report.junit_text([suite]))
    show_result(finished.result, finished.document, shown, quiet=quiet)
    if shown is Format.GITHUB:
        show_annotations(finished.content)
    if not quiet:
        _sum_up(run, finished.result, started)
    return _exit_code(finished.result)


def _append_step_summary(content: report.SweepContent) -> None:
    # The results are written already: a failure to write the step summary does not undo them.
    try:
        report.append_sweep_step_summary(content)
    except OSError as error:
        message(f"uictest: GITHUB_STEP_SUMMARY cannot be written: {error}")


def _report_finished_chunks(run: runs.SweepRun) -> None:
    if chunked.ChunkStore(run.folder).has_chunks():
        message(f"uictest: finished chunks are kept in {run.folder}; the same command continues")


def _shard_words(run: runs.SweepRun) -> str:
    shard, chunks = f"shard {run.shard.number} of {run.shard.count}", run.selection.chunks
    if run.shard.chunk_numbers(chunks):
        return f"{shard} is finished in {run.folder}"
    return f"{shard} has no cases: the sweep has only {counted(chunks, 'chunk')}"


def _exit_code(result: report.SweepResult) -> ExitCode:
    """Return the exit code of a complete sweep: an error takes precedence over a missed case."""
    if result.outcomes["error"]:
        return ExitCode.ERROR
    return ExitCode.MET if result.met == result.cases else ExitCode.MISSED


def _sum_up(run: runs.SweepRun, result: report.SweepResult, started: float) -> None:
    """Report on stderr the counts of the sweep and the folder of its files."""
    seconds = perf_counter() - started
    message(f"uictest: {report.sweep_tally(result)} in {seconds:.1f} s; results in {run.folder}")
