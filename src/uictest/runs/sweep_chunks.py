"""What is asked of a sweep besides its cases, and its chunks, run."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from uictest import report, rig
from uictest.analysis import summaries, validation
from uictest.plans import sweeps
from uictest.plans.scenario import Case, yaml
from uictest.running import chunked
from uictest.running.chunked import CaseSelection, ChangedInputsError, ChunkRunner, ChunkStore, Shard
from uictest.runs.errors import InvalidInputError
from uictest.runs.observer import Observer


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
        """Return what runs its chunks in this process."""
        return chunked.chunk_runner(self.selection.plan, self.run_block, self.run_train)


class MaxfailReached(Exception):  # noqa: N818 - nothing went wrong with the program
    """`maxfail` cases missed their expectation; the message gives their number and the first."""


def run_missing_chunks(
    request: SweepRequest,
    store: ChunkStore,
    observer: Observer,
    on_finished: Callable[[int], None] = lambda end: None,
    meanwhile: Callable[[], None] = lambda: None,
) -> None:
    """Run the chunks of the run's shard that are not finished, and write them to the store.

    While others run, `on_finished` is told the number before which all chunks are finished, and `meanwhile`
    is called once.

    Finished chunks are kept whatever is raised: InvalidInputError where the folder holds the chunks of other
    inputs, OSError where it cannot be written, KeyboardInterrupt, MaxfailReached.
    """
    _open_store(request, store, observer)
    finished, damaged = store.finished()
    for path in damaged:
        observer.damaged(path)
    own_chunks = request.shard.chunk_numbers(request.selection.chunks)
    missing_chunks = [number for number in own_chunks if number not in finished]
    cases, missing_cases = (_cases_in(request, numbers) for numbers in (own_chunks, missing_chunks))
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
            _run_chunks(request, missing_chunks, write_chunk, observer, meanwhile)


def _cases_in(request: SweepRequest, numbers: Sequence[int]) -> int:
    return sum(request.selection.chunk(number).size for number in numbers)


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
    request: SweepRequest,
    numbers: Sequence[int],
    write_chunk: chunked.WriteChunk,
    observer: Observer,
    meanwhile: Callable[[], None],
) -> None:
    address = request.cluster
    if address is None:
        chunked.run_on_threads(
            request.runner(), request.selection, numbers, request.jobs, write_chunk, meanwhile
        )
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


def reason_missed(reason: str) -> str:
    """Return why a case is not met; one that passes unexpectedly has no reason of its own."""
    return reason or "another outcome was expected"


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
        missed = _missed(content)
        if missed and not self._first:
            outcome, name, reason = missed[0]
            self._first = f"{name}: {outcome}, {reason_missed(reason)}"
        self._count += len(missed)
        if self._count >= self._maxfail:
            raise MaxfailReached(f"{report.counted(self._count, 'case')} not met, the first: {self._first}")


def _missed(content: bytes) -> list[tuple[str, str, str]]:
    """Return outcome, id and reason of the missed cases in a chunk."""
    import pyarrow.parquet as pq

    names = ["met", "outcome", "id", "reason"]
    columns = pq.read_table(io.BytesIO(content), columns=names).to_pydict()
    rows = zip(*(columns[name] for name in names), strict=True)
    return [(outcome, name, reason) for met, outcome, name, reason in rows if not met]


class ToleranceError(ValueError):
    """A tolerance of a frontier that is no number with a unit."""


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
