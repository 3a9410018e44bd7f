"""Run a sweep, show it, and return its exit code."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter

from uictest import report, runs
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import Format
from uictest.cli.output import message
from uictest.cli.sweep.display import show_annotations, show_result
from uictest.cli.sweep.following import TerminalSweepObserver
from uictest.core import files
from uictest.report import counted
from uictest.running import chunked
from uictest.runs import history


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
    finished = runs.run_sweep(run, TerminalSweepObserver(quiet=quiet, merging=bool(run.merged)))
    if finished is None:
        message(f"uictest: {_shard_words(run)}")
        return ExitCode.MET
    if problem := history.refresh_index(run.folder.parent):
        message(f"uictest: {problem}")
    _append_step_summary(finished.content)
    if junit is not None:
        text = report.sweep_junit_xml(finished.result, run.selection.plan.file)
        files.write_to(junit, text)
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
