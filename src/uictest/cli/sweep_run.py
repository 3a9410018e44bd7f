"""A sweep from its parts to its findings."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from uictest import recording, report, sweep
from uictest.cli.compilation import announce_compilation
from uictest.cli.exit_codes import ExitCode
from uictest.cli.problems import InvalidInputError
from uictest.cli.streams import message
from uictest.cli.sweep_display import reason_missed
from uictest.cli.sweep_progress import sweep_progress
from uictest.report import counted
from uictest.sweep import ChangedInputsError, ChunkRunner, FrontierSearch, Selection, Shard, Store, run_parts

if TYPE_CHECKING:
    from uictest.campaign import CaseRun


@dataclass(frozen=True)
class SweepRun:
    """What is to be swept, how, and where its results go."""

    selection: Selection
    manifest: dict[str, Any]
    folder: Path
    jobs: int
    shard: Shard = field(default_factory=Shard)
    shares: Sequence[Path] = ()
    """Folders of shares to be put together."""
    cluster: str | None = None
    restart: bool = False
    maxfail: int | None = None
    pair: tuple[str, str] | None = None
    measures: Sequence[str] = ()
    search: FrontierSearch | None = None
    junit: Path | None = None
    formats: Sequence[report.ReportFormat] = ()
    quiet: bool = False


class MaxfailReached(Exception):  # noqa: N818 - nothing went wrong with the program
    """As many cases as are tolerated did not meet their expectation; the message says how many and which."""


def simulate_parts(run: SweepRun, store: Store) -> None:
    """Work out what is missing of the run's share, and keep it.

    Raises InvalidInputError where the folder holds the parts of other inputs, OSError where it takes no more,
    KeyboardInterrupt, and MaxfailReached; whatever it is, finished parts are kept.
    """
    _begin(run, store)
    finished, damaged = store.finished()
    for path in damaged:
        message(f"uictest: {path} is damaged; its part is worked out again")
    mine = run.shard.of(run.selection.parts)
    missing = [number for number in mine if number not in finished]
    cases = sum(run.selection.part(number).size for number in mine)
    left = sum(run.selection.part(number).size for number in missing)
    _announce(run, cases, left)
    with sweep_progress(cases, cases - left, quiet=run.quiet) as advance:
        failures = _Failures(run.maxfail)

        def keep(number: int, content: bytes) -> None:
            store.write(number, content)
            advance(run.selection.part(number).size)
            failures.take(content)

        if missing:
            _work(run, missing, keep)


def _announce(run: SweepRun, cases: int, left: int) -> None:
    """Say what there is already; or what no share brought: it may be hours of work that nobody expects."""
    if run.shares and left:
        verb = "is in no share: it is" if left == 1 else "are in no share: they are"
        message(f"uictest: {left} of {counted(cases, 'case')} {verb} worked out here")
    elif left < cases and not run.quiet:
        message(f"uictest: {cases - left} of {counted(cases, 'case')} are finished already")


def _begin(run: SweepRun, store: Store) -> None:
    try:
        store.begin(run.manifest, restart=run.restart)
    except ChangedInputsError as error:
        raise InvalidInputError(
            f"uictest: {run.folder} holds parts of this sweep with other inputs ({error}); "
            "--restart discards them, -o names another folder"
        ) from error
    for folder in run.shares:
        try:
            taken, damaged = store.take(Store(folder))
        except ChangedInputsError as error:
            raise InvalidInputError(f"uictest: not a share of this sweep: {error}") from error
        for path in damaged:
            message(f"uictest: {path} is damaged and left behind")
        message(f"uictest: {counted(taken, 'part')} from {folder}")


def _work(run: SweepRun, missing: Sequence[int], keep: Callable[[int, bytes], None]) -> None:
    if run.cluster is not None:
        _work_on_cluster(run, run.cluster, missing, keep)
        return
    worker = prepared_worker(run)
    run_parts(
        missing, lambda number: worker.part(run.selection.part(number)), min(run.jobs, len(missing)), keep
    )


def _work_on_cluster(
    run: SweepRun, address: str, missing: Sequence[int], keep: Callable[[int, bytes], None]
) -> None:
    def wait() -> None:
        message(f"uictest: waiting for workers at {address}")

    try:
        sweep.run_on_cluster(run.selection, missing, address, keep, wait)
    except ImportError as error:
        raise InvalidInputError("uictest: --dask needs the extra: pip install 'uictest[dask]'") from error
    except sweep.ClusterError as error:
        raise OSError(str(error)) from error


def prepared_worker(run: SweepRun) -> ChunkRunner:
    """Return a worker whose rig is compiled, having said so where that takes time.

    Raises InvalidInputError where there is no GPU and one is asked for.
    """
    if run.selection.device == "cuda":
        return _worker_on_gpu(run)
    announce_compilation(warm=sweep.is_warm(), quiet=run.quiet)
    made = sweep.chunk_runner(run.selection.plan)
    made.prepare()
    return made


def _worker_on_gpu(run: SweepRun) -> ChunkRunner:
    try:
        made = sweep.chunk_runner(run.selection.plan, "cuda")
        made.prepare()
    except sweep.NoDeviceError as error:
        raise InvalidInputError(
            f"uictest: no CUDA device found ({error}); leave --device out to use the processor"
        ) from error
    except ImportError as error:
        # The compiler for GPUs is looked for at its first use, and belongs to the extra, too.
        raise InvalidInputError(
            "uictest: --device cuda needs the extra: pip install 'uictest[cuda]'"
        ) from error
    return made


class _Failures:
    """Counts the cases that are not met, part by part, until there are as many as are tolerated."""

    def __init__(self, tolerated: int | None) -> None:
        self._tolerated = tolerated
        self._count = 0
        self._first = ""

    def take(self, content: bytes) -> None:
        """Count those of a finished part. Raises MaxfailReached."""
        if self._tolerated is None:
            return
        missed = _missed(content)
        if missed and not self._first:
            outcome, name, reason = missed[0]
            self._first = f"{name}: {outcome}, {reason_missed(reason)}"
        self._count += len(missed)
        if self._count >= self._tolerated:
            raise MaxfailReached(f"{counted(self._count, 'case')} not met, the first: {self._first}")


def _missed(content: bytes) -> list[tuple[str, str, str]]:
    """Return outcome, id and reason of the cases in a part that are not met."""
    import io

    import pyarrow.parquet as pq

    names = ["met", "outcome", "id", "reason"]
    columns = pq.read_table(io.BytesIO(content), columns=names).to_pydict()
    rows = zip(*(columns[name] for name in names), strict=True)
    return [(outcome, name, reason) for met, outcome, name, reason in rows if not met]


def publish(run: SweepRun, store: Store) -> tuple[sweep.SweepFindings, str, report.SweepContent]:
    """Write what the finished sweep says; return it, the text of the result document and what reports show.

    Raises OSError, and MissingPartsError where a share is missing.
    """
    findings = sweep.gather(run.selection, store, run.pair, run.measures)
    if run.search is not None:
        _add_frontier(run, findings, run.search)
    _examine_worst(run, findings, store.folder)
    document = sweep.write_findings(store.folder, findings)
    content = _write_reports(run, store.folder)
    if run.junit is not None:
        recording.write_text_atomic(run.junit, sweep.junit_xml(findings.tally))
    store.tidy()
    return findings, document, content


def _write_reports(run: SweepRun, folder: Path) -> report.SweepContent:
    content = report.read_sweep(folder, traces=report.ReportFormat.HTML in run.formats)
    report.write_sweep_formats(folder, content, run.formats)
    # The findings are written by now: a summary that cannot be written does not undo them.
    try:
        report.append_sweep_step_summary(content)
    except OSError as error:
        message(f"uictest: GITHUB_STEP_SUMMARY cannot be written: {error}")
    return content


def _examine_worst(run: SweepRun, findings: sweep.SweepFindings, folder: Path) -> None:
    """Run the cases most worth looking at once more, in full, and keep their recordings beside the tables.

    Raises OSError, and KeyboardInterrupt where it was interrupted.
    """
    import shutil

    from uictest.campaign import (
        RecordingRequest,
        parts_of_cases,
        run_cases as examine,
        shortest_cycle,
        subjects_of,
    )

    cases = sweep.cases_of(run.selection.plan, findings.worst_indices)
    shutil.rmtree(folder / report.RECORDINGS, ignore_errors=True)

    def keep(examined: CaseRun) -> None:
        if examined.recording is not None:
            report.write_recording(folder, examined.result.id, examined.recording)

    wish = RecordingRequest("all")
    wish = replace(wish, every=min(wish.every, shortest_cycle(cases)))
    campaign = examine(cases, jobs=run.jobs, recording=wish, parts=parts_of_cases(cases), on_result=keep)
    if campaign.interrupted:
        raise KeyboardInterrupt
    findings.worst, findings.subjects = campaign.results, subjects_of(cases)


def _add_frontier(run: SweepRun, findings: sweep.SweepFindings, search: FrontierSearch) -> None:
    if not run.quiet:
        message(f"uictest: looking for the frontier along {search.key}")
    simulate = prepared_worker(run).simulate
    findings.frontier_key = search.key
    findings.frontier = search.run(
        findings.verdicts, lambda plan, indices: sweep.verdicts_of(plan, indices, simulate, run.jobs)
    )


def exit_code(findings: sweep.SweepFindings) -> ExitCode:
    """Return the exit code of a complete sweep: an error outweighs a missed case."""
    total = findings.tally.total()
    if total.outcomes["error"]:
        return ExitCode.ERROR
    return ExitCode.MET if total.met == total.cases else ExitCode.MISSED


def sum_up(run: SweepRun, findings: sweep.SweepFindings, started: float) -> None:
    """Say on stderr what the sweep came to and where its files are."""
    total = findings.tally.total()
    shown = report.sweep_tally({"cases": total.cases, "met": total.met, "outcomes": total.outcomes})
    seconds = perf_counter() - started
    message(f"uictest: {shown} in {seconds:.1f} s; results in {run.folder}")
