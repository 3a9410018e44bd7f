"""A sweep from its lock to its published results."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from uictest import controllers, report, rig
from uictest.analysis import summaries, validation
from uictest.core import files
from uictest.judging import evaluation
from uictest.plans import scenario, sweeps
from uictest.plans.scenario import Case, yaml
from uictest.running import campaign, chunked
from uictest.running.chunked import CaseSelection, ChangedInputsError, ChunkRunner, ChunkStore, Shard
from uictest.runs.batch import simulate_cases
from uictest.runs.observer import Observer
from uictest.runs.publishing import locked_folder
from uictest.runs.scenario_files import InvalidInputError


@dataclass(frozen=True)
class SweepRequest:
    """The cases of a sweep, options of the run, and the folder of the results."""

    selection: CaseSelection
    manifest: dict[str, Any]
    folder: Path
    jobs: int
    shard: Shard = field(default_factory=Shard)
    merged: Sequence[Path] = ()
    """Folders of shards to merge."""
    cluster: str | None = None
    restart: bool = False
    maxfail: int | None = None
    pair: tuple[str, str] | None = None
    measures: Sequence[str] = ()
    search: summaries.FrontierSearch | None = None
    reference: validation.ValidationReference | None = None
    """Validation that the cases are held against."""
    firm: bool = False
    """Whether it is asked how firm the verdicts of the nominal case are."""
    calibration: Sequence[Case] = ()
    """Stops by which the numbers varied for that are known."""
    formats: Sequence[str] | None = None
    """Of reports; None for tables and the page, and only the page where the cases are very many."""
    in_process: bool = False
    run_block: chunked.RunBlock = rig.run_block
    """Simulates blocks with controllers from outside."""
    run_train: rig.RunTrain = rig.run_train_in_process
    """Simulates trains with such controllers."""

    @property
    def reports(self) -> Sequence[str]:
        """The formats of the reports."""
        if self.formats is not None:
            return self.formats
        return ("html",) if self.selection.size > report.LARGEST_CSV else ("csv", "html")

    @property
    def writes_csv(self) -> bool:
        """Whether there is a row for every case in CSV, too."""
        return self.selection.size <= report.LARGEST_CSV or "csv" in self.reports

    def runner(self) -> ChunkRunner:
        """Return the runner of its chunks in this process."""
        return chunked.chunk_runner(self.selection.plan, self.run_block, self.run_train)


class MaxfailReached(Exception):  # noqa: N818 - nothing went wrong with the program
    """`maxfail` cases missed their expectation; the message gives their number and the first."""


class FinishedSweep(NamedTuple):
    """A sweep whose results are written: these, the text of results.json, and what its reports show."""

    result: report.SweepResult
    document: str
    content: report.SweepContent
    publication: report.Publication


def run_sweep(request: SweepRequest, observer: Observer) -> FinishedSweep | None:
    """Run a sweep; chunks that are finished already are not run again.

    Returns the finished sweep, None where this run is one shard of several. Finished chunks are kept whatever
    is raised: InvalidInputError where the folder is in use or holds the chunks of other inputs, OSError,
    KeyboardInterrupt, MaxfailReached.
    """
    with (
        locked_folder(request.folder, shared=request.shard.count > 1 and not request.restart),
        rig.Workers() as workers,
    ):
        if request.in_process and any(sweeps.programs_of(request.selection.plan)):
            observer.foreign_in_process()
        in_children = replace(request, run_block=workers.run_block, run_train=workers.run_train)
        prepared = request if request.in_process else in_children
        try:
            store = ChunkStore(request.folder)
            if request.shard.count > 1:
                run_missing_chunks(prepared, store, observer)
                return None
            return publish(prepared, store, summarized_chunks(prepared, store, observer), observer)
        except KeyboardInterrupt:
            controllers.interrupt_turns()
            raise


def summarized_chunks(request: SweepRequest, store: ChunkStore, observer: Observer) -> summaries.SweepSummary:
    """Run the chunks that are not finished; return what all come to, summarised while others run.

    Raises what :func:`run_missing_chunks` does.
    """
    options = request.pair, request.measures, request.reference
    with summaries.summarized(request.selection, store, *options, csv=request.writes_csv) as summary:
        run_missing_chunks(request, store, observer, summary.add_up_to)
        with files.writing(store.folder):
            files.begin_list(store.folder)
        return summary.result()


def publish(
    request: SweepRequest, store: ChunkStore, summary: summaries.SweepSummary, observer: Observer
) -> FinishedSweep:
    """Write the result of a summarised sweep and its reports. Raises OSError."""
    frontier = None
    if (search := request.search) is not None:
        observer.searching(search.key)
        runner = request.runner()
        scans = search.run(
            summary.verdicts, lambda plan, indices: summaries.verdicts_of(plan, indices, runner, request.jobs)
        )
        frontier = report.Frontier(search.key, tuple(scans))
    worst = _run_worst(request, summary, store.folder)
    result = replace(summary.result, frontier=frontier, worst=worst.results, subjects=worst.subjects)
    if request.firm:
        result = replace(result, nominal=_nominal_with_firmness(request, observer))
    document = report.write_sweep_result(store.folder, result)
    # Read back, so that what is shown now is what `uictest report` shows of the folder later.
    content = replace(report.read_sweep(store.folder), traces=worst.traces)
    publication = report.publication_of_sweep(content)
    rows, *others = publication.tables
    in_csv = replace(publication, tables=[rows, *others] if request.writes_csv else others)
    report.publish(in_csv, ["csv"], store.folder)
    report.publish(publication, ["junit", *(name for name in request.reports if name != "csv")], store.folder)
    store.remove_partial_files()
    return FinishedSweep(result, document, content, publication)


class _WorstCases(NamedTuple):
    """The worst cases of a sweep: their results; their descriptions, and what is drawn of them, by id."""

    results: tuple[evaluation.CaseResult, ...]
    subjects: Mapping[str, report.CaseDescription]
    traces: Mapping[str, report.PlotTrace]


def _run_worst(request: SweepRequest, summary: summaries.SweepSummary, folder: Path) -> _WorstCases:
    """Run the worst cases again as their rows were, with explanations, and write their recordings.

    What is drawn of them is taken while others run. Raises OSError, and KeyboardInterrupt if interrupted.
    """
    cases = summaries.full_cases(request.selection.plan, summary.worst_indices, summary.surveyed)
    files.remove_listed(folder, f"{report.RECORDINGS}/*")
    traces: dict[str, report.PlotTrace] = {}

    def write_recording(case_run: campaign.CaseRun) -> None:
        result, samples = case_run.result, case_run.recording
        if samples is not None:
            report.write_recording(folder, result.id, samples)
            if not report.DRAWING.isdisjoint(request.reports):
                traces[result.id] = report.trace_of_stop(samples, result)

    recording = campaign.RecordingRequest("all")
    recording = recording._replace(every=min(recording.every, campaign.shortest_cycle(cases)))
    settings = _run_settings(request, cases, recording)
    if request.reference is not None:
        settings = replace(settings, domains=request.reference.domains_of(settings.parts))
    results = campaign.run_cases(cases, settings, on_case=write_recording).whole()
    return _WorstCases(tuple(results), campaign.descriptions_of(cases), traces)


def _nominal_with_firmness(request: SweepRequest, observer: Observer) -> tuple[evaluation.CaseResult, ...]:
    """Return the result of the case that is varied, of a train those of all cars, with how firm each is.

    Raises KeyboardInterrupt.
    """
    base = request.selection.plan.base
    train = base.train
    cases = [base]
    if train is not None:
        cases = [
            replace(
                base,
                id=f"{train.train}[{scenario.CAR}={number}]",
                scenario=stated,
                parameters={scenario.CAR: str(number)},
                train=replace(train, number=number),
            )
            for number, stated in enumerate(train.scenarios, start=1)
        ]
    settings = _run_settings(request, cases, campaign.RecordingRequest("none"))
    settings = replace(settings, firm=True, calibration=request.calibration)
    return tuple(simulate_cases(cases, settings, observer, unit="stops").whole())


def _run_settings(
    request: SweepRequest, cases: Sequence[scenario.Case], recording: campaign.RecordingRequest
) -> campaign.RunSettings:
    """Return the settings for running cases of a sweep one by one."""
    parts = campaign.parts_of_cases(cases)
    return campaign.RunSettings(request.jobs, recording, in_process=request.in_process, parts=parts)


def run_missing_chunks(
    request: SweepRequest,
    store: ChunkStore,
    observer: Observer,
    on_finished: Callable[[int], None] = lambda end: None,
) -> None:
    """Run the chunks of the run's shard that are not finished, and write them to the store.

    While others run, `on_finished` is told the number before which all chunks are finished.

    Finished chunks are kept whatever is raised: InvalidInputError where the folder holds the chunks of other
    inputs, OSError where it cannot be written, KeyboardInterrupt, MaxfailReached.
    """
    _open_store(request, store, observer)
    finished, damaged = store.finished()
    for path in damaged:
        observer.damaged(path)
    own_chunks = request.shard.chunk_numbers(request.selection.chunks)
    missing_chunks = [number for number in own_chunks if number not in finished]
    cases, missing_cases = (
        sum(request.selection.chunk(number).size for number in numbers)
        for numbers in (own_chunks, missing_chunks)
    )
    observer.found(cases, missing_cases)
    if missing_chunks and request.cluster is None:
        rig.compiled_rig()  # as before a run of single cases
    with observer.simulating(cases, cases - missing_cases) as advance:
        failures, unfinished = _Failures(request.maxfail), dict.fromkeys(missing_chunks)

        def write_chunk(number: int, content: bytes) -> None:
            store.write(number, content)
            del unfinished[number]
            advance(request.selection.chunk(number).size)
            failures.add(content)
            on_finished(next(iter(unfinished), request.selection.chunks))

        if missing_chunks:
            _run_chunks(request, missing_chunks, write_chunk, observer)


def _open_store(request: SweepRequest, store: ChunkStore, observer: Observer) -> None:
    try:
        store.open(request.manifest, restart=request.restart)
    except ChangedInputsError as error:
        raise InvalidInputError(
            f"{request.folder} holds chunks of this sweep with other inputs ({error}): "
            "restart it to discard them, or name another output folder",
            arguments=("restart", "output"),
        ) from error
    for folder in request.merged:
        try:
            merged_chunks, damaged = store.merge(ChunkStore(folder))
        except ChangedInputsError as error:
            raise InvalidInputError(f"not a shard of this sweep: {error}") from error
        for path in damaged:
            observer.damaged_in_shard(path)
        observer.merged(merged_chunks, folder)


def _run_chunks(
    request: SweepRequest, numbers: Sequence[int], write_chunk: chunked.WriteChunk, observer: Observer
) -> None:
    address = request.cluster
    if address is None:
        chunked.run_on_threads(request.runner(), request.selection, numbers, request.jobs, write_chunk)
        return
    try:
        chunked.run_on_cluster(
            *(request.selection, numbers, address, write_chunk), lambda: observer.waiting(address)
        )
    except ImportError as error:
        raise InvalidInputError(
            "a cluster needs the extra: pip install 'uictest[dask]'", arguments=("cluster",)
        ) from error
    except chunked.ClusterError as error:
        raise OSError(str(error)) from error


class _Failures:
    """Counts the missed cases, chunk by chunk, up to `maxfail`."""

    def __init__(self, maxfail: int | None) -> None:
        self._maxfail = maxfail
        self._count = 0
        self._first = ""

    def add(self, content: bytes) -> None:
        """Count the missed cases of a finished chunk. Raises MaxfailReached."""
        if self._maxfail is None:
            return
        import pyarrow.parquet as pq

        names = ["met", "outcome", "id", "reason"]
        columns = pq.read_table(io.BytesIO(content), columns=names).to_pydict()
        rows = zip(*(columns[name] for name in names), strict=True)
        missed = [(outcome, name, reason) for met, outcome, name, reason in rows if not met]
        if missed and not self._first:
            outcome, name, reason = missed[0]
            self._first = f"{name}: {outcome}, {reason or 'another outcome was expected'}"
        self._count += len(missed)
        if self._count >= self._maxfail:
            raise MaxfailReached(f"{report.counted(self._count, 'case')} not met, the first: {self._first}")


class ToleranceError(ValueError):
    """A tolerance of a frontier that is not a number with a unit."""


def first_pair(plan: sweeps.Plan) -> tuple[str, str] | None:
    """Return the first two parameters with several listed values, None without two of them."""
    listed = [key for key, values in plan.listed().items() if len(values) > 1]
    return (listed[0], listed[1]) if len(listed) > 1 else None


def measure_names(names: Sequence[str] | None) -> tuple[str, ...]:
    """Return columns of measures, else the braking distance. Raises ValueError for another name."""
    columns = chunked.measure_columns()
    for name in names or ():
        if name not in columns:
            raise ValueError(f"no measure {name!r}; {yaml.suggestion(name, columns)}")
    return tuple(dict.fromkeys(names or ("braking_distance_m",)))


def frontier_search(
    plan: sweeps.Plan, key: str | None, tolerance: str | None
) -> summaries.FrontierSearch | None:
    """Return the search of a frontier along a parameter.

    Raises FrontierError for the parameter, ToleranceError for the tolerance.
    """
    if key is None:
        return None
    try:
        width = None if tolerance is None else yaml.parse_decimal_quantity(tolerance)
        return summaries.FrontierSearch(plan, key, width)
    except summaries.FrontierError:
        raise
    except ValueError as error:
        raise ToleranceError(str(error)) from error
