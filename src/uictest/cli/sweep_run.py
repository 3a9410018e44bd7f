"""A sweep from its parts to its findings."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from uictest.cli.compilation import announce_compilation
from uictest.cli.exit_codes import ExitCode
from uictest.cli.problems import InvalidInputError
from uictest.cli.streams import message
from uictest.cli.sweep_display import reason_missed
from uictest.cli.sweep_progress import sweep_progress
from uictest.report import counted
from uictest.sweep import ChangedInputsError, Search, Selection, Shard, Store, Worker, run_parts

if TYPE_CHECKING:
    from uictest.campaign import Examined
    from uictest.report import ReportFormat, SweepContent
    from uictest.sweep.findings import Findings


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
    search: Search | None = None
    junit: Path | None = None
    formats: Sequence[ReportFormat] = ()
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
    from uictest.sweep.cluster import ClusterError, run_on_cluster

    def wait() -> None:
        message(f"uictest: waiting for workers at {address}")

    try:
        run_on_cluster(run.selection, missing, address, keep, wait)
    except ImportError as error:
        raise InvalidInputError("uictest: --dask needs the extra: pip install 'uictest[dask]'") from error
    except ClusterError as error:
        raise OSError(str(error)) from error


def prepared_worker(run: SweepRun) -> Worker:
    """Return a worker whose rig is compiled, having said so where that takes time.

    Raises InvalidInputError where there is no GPU and one is asked for.
    """
    from uictest.sweep import worker
    from uictest.sweep.simulating import is_warm

    if run.selection.device == "cuda":
        return _worker_on_gpu(run)
    announce_compilation(warm=is_warm(), quiet=run.quiet)
    made = worker(run.selection.plan)
    made.prepare()
    return made


def _worker_on_gpu(run: SweepRun) -> Worker:
    from uictest.sweep import worker
    from uictest.sweep.simulating import NoDeviceError

    try:
        made = worker(run.selection.plan, "cuda")
        made.prepare()
    except NoDeviceError as error:
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


def publish(run: SweepRun, store: Store) -> tuple[Findings, str, SweepContent]:
    """Write what the finished sweep says; return it, the text of the result document and what reports show.

    Raises OSError, and MissingPartsError where a share is missing.
    """
    from uictest.recording import write_text_atomic
    from uictest.sweep.findings import gather, write_findings
    from uictest.sweep.junit import junit_xml

    findings = gather(run.selection, store, run.pair, run.measures)
    if run.search is not None:
        _add_frontier(run, findings, run.search)
    _examine_worst(run, findings, store.folder)
    document = write_findings(store.folder, findings)
    content = _write_reports(run, store.folder)
    if run.junit is not None:
        write_text_atomic(run.junit, junit_xml(findings.tally))
    store.tidy()
    return findings, document, content


def _write_reports(run: SweepRun, folder: Path) -> SweepContent:
    from uictest.report import ReportFormat, append_sweep_step_summary, read_sweep, write_sweep_formats

    content = read_sweep(folder, traces=ReportFormat.HTML in run.formats)
    write_sweep_formats(folder, content, run.formats)
    # The findings are written by now: a summary that cannot be written does not undo them.
    try:
        append_sweep_step_summary(content)
    except OSError as error:
        message(f"uictest: GITHUB_STEP_SUMMARY cannot be written: {error}")
    return content


def _examine_worst(run: SweepRun, findings: Findings, folder: Path) -> None:
    """Run the cases most worth looking at once more, in full, and keep their recordings beside the tables.

    Raises OSError, and KeyboardInterrupt where it was interrupted.
    """
    import shutil

    from uictest.campaign import RecordingWish, parts_of_cases, shortest_cycle, subjects_of
    from uictest.campaign import run as examine
    from uictest.report import write_recording
    from uictest.report.run_report import RECORDINGS
    from uictest.sweep.worst import cases_of

    cases = cases_of(run.selection.plan, findings.worst_indices)
    shutil.rmtree(folder / RECORDINGS, ignore_errors=True)

    def keep(examined: Examined) -> None:
        if examined.recording is not None:
            write_recording(folder, examined.result.id, examined.recording)

    wish = RecordingWish("all")
    wish = replace(wish, every=min(wish.every, shortest_cycle(cases)))
    campaign = examine(cases, jobs=run.jobs, recording=wish, parts=parts_of_cases(cases), on_result=keep)
    if campaign.interrupted:
        raise KeyboardInterrupt
    findings.worst, findings.subjects = campaign.results, subjects_of(cases)


def _add_frontier(run: SweepRun, findings: Findings, search: Search) -> None:
    from uictest.sweep.verdicts import verdicts_of

    if not run.quiet:
        message(f"uictest: looking for the frontier along {search.key}")
    simulate = prepared_worker(run).simulate
    findings.frontier_key = search.key
    findings.frontier = search.run(
        findings.verdicts, lambda plan, indices: verdicts_of(plan, indices, simulate, run.jobs)
    )


def exit_code(findings: Findings) -> ExitCode:
    """Return the exit code of a complete sweep: an error outweighs a missed case."""
    total = findings.tally.total()
    if total.outcomes["error"]:
        return ExitCode.ERROR
    return ExitCode.MET if total.met == total.cases else ExitCode.MISSED


def sum_up(run: SweepRun, findings: Findings, started: float) -> None:
    """Say on stderr what the sweep came to and where its files are."""
    from uictest.report.sweep.wording import sweep_tally

    total = findings.tally.total()
    shown = sweep_tally({"cases": total.cases, "met": total.met, "outcomes": total.outcomes})
    seconds = perf_counter() - started
    message(f"uictest: {shown} in {seconds:.1f} s; results in {run.folder}")
