"""Run a sweep from its lock to its exit code."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from time import perf_counter

from uictest import controllers, report, rig
from uictest.cli.exit_codes import ExitCode, InvalidInputError
from uictest.cli.options import Format
from uictest.cli.output import message
from uictest.cli.progress import announce_in_process
from uictest.cli.sweep.display import show_annotations, show_result
from uictest.cli.sweep.publishing import publish
from uictest.cli.sweep.run import MaxfailReached, SweepRun, run_missing_chunks
from uictest.folder_lock import FolderInUseError, FolderLock
from uictest.report import counted
from uictest.sweep import ChunkStore, programs_of


def execute_sweep(run: SweepRun, shown: Format) -> ExitCode:
    """Run a sweep and show its result; return its exit code. Raises InvalidInputError, OSError."""
    with _locked(run.folder, shared=run.shard.count > 1 and not run.restart), rig.Workers() as workers:
        foreign = run.in_process and any(programs_of(run.selection.plan))
        announce_in_process(foreign=foreign, quiet=run.quiet)
        isolated = run if run.in_process else replace(run, run_block=workers.run_block)
        return _run_and_report_end(isolated, shown)


def _run_and_report_end(run: SweepRun, shown: Format) -> ExitCode:
    store = ChunkStore(run.folder)
    try:
        return _run_and_show(run, store, shown)
    except MaxfailReached as reached:
        message(f"uictest: stopped at --maxfail: {reached}")
        message(
            f"uictest: finished chunks are kept in {run.folder}; the same command without --maxfail continues"
        )
        return ExitCode.MISSED
    except KeyboardInterrupt:
        controllers.interrupt_turns()
        message("uictest: interrupted")
        _report_finished_chunks(store)
        return ExitCode.INTERRUPTED
    except OSError:
        _report_finished_chunks(store)
        raise


def _run_and_show(run: SweepRun, store: ChunkStore, shown: Format) -> ExitCode:
    started = perf_counter()
    run_missing_chunks(run, store)
    if run.shard.count > 1:
        message(f"uictest: {_shard_words(run)}")
        return ExitCode.MET
    result, document, content = publish(run, store)
    show_result(result, document, shown, quiet=run.quiet)
    if shown is Format.GITHUB:
        show_annotations(content)
    if not run.quiet:
        _sum_up(run, result, started)
    return _exit_code(result)


def _report_finished_chunks(store: ChunkStore) -> None:
    if store.has_chunks():
        message(f"uictest: finished chunks are kept in {store.folder}; the same command continues")


def _shard_words(run: SweepRun) -> str:
    shard, chunks = f"shard {run.shard.number} of {run.shard.count}", run.selection.chunks
    if run.shard.chunk_numbers(chunks):
        return f"{shard} is finished in {run.folder}"
    return f"{shard} has no cases: the sweep has only {counted(chunks, 'chunk')}"


def _locked(folder: Path, *, shared: bool) -> FolderLock:
    """Return the lock on the folder of a sweep; shards of the sweep share it."""
    folder.mkdir(parents=True, exist_ok=True)
    try:
        return FolderLock(folder, shared=shared)
    except FolderInUseError as error:
        raise InvalidInputError(
            f"uictest: {folder} is in use by {error}: wait until it ends, or name another folder with -o"
        ) from error


def _exit_code(result: report.SweepResult) -> ExitCode:
    """Return the exit code of a complete sweep: an error takes precedence over a missed case."""
    if result.outcomes["error"]:
        return ExitCode.ERROR
    return ExitCode.MET if result.met == result.cases else ExitCode.MISSED


def _sum_up(run: SweepRun, result: report.SweepResult, started: float) -> None:
    """Report on stderr the counts of the sweep and the folder of its files."""
    seconds = perf_counter() - started
    message(f"uictest: {report.sweep_tally(result)} in {seconds:.1f} s; results in {run.folder}")
