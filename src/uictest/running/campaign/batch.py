"""Run many cases on threads, with results in order; the compiled rig releases the interpreter's lock."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import chain, islice
from types import TracebackType
from typing import Final, Generic, TypeVar

from uictest import controllers, rig
from uictest.core import recording
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.rig import bench
from uictest.running.campaign.stop import (
    Block,
    CaseAssembly,
    CaseRun,
    RecordingRequest,
    StopRun,
    blocks_of,
    run_block,
    trains_in,
)

Argument = TypeVar("Argument")
Result = TypeVar("Result")

_PENDING_PER_THREAD = 4
"""Calls handed to the pool per thread unless stated otherwise: bounds memory and wasted work."""


class ThreadedMap(Generic[Argument, Result]):
    """Applies `work` to each argument on `jobs` threads; iterate over it, inside `with`, for the results.

    Leaving the `with` block cancels the calls that have not started, and waits for those in progress. After
    an exception it does not wait: a call cannot be cancelled, and an interrupt should take effect at once.

    Args:
        work: the function; its exceptions are raised when its result is requested.
        arguments: one for each call, read only when the call is submitted.
        jobs: number of threads.
        pending: most calls that are submitted and whose results are not yet returned [default: 4 per thread].
    """

    def __init__(
        self,
        work: Callable[[Argument], Result],
        arguments: Iterable[Argument],
        *,
        jobs: int,
        pending: int | None = None,
    ) -> None:
        self._work = work
        self._arguments = iter(arguments)
        self._pool = ThreadPoolExecutor(max_workers=jobs, thread_name_prefix="uictest")
        self._pending: deque[Future[Result]] = deque()
        self._most_pending = pending or jobs * _PENDING_PER_THREAD

    def __enter__(self) -> ThreadedMap[Argument, Result]:
        """Submit the first calls."""
        self._submit(self._most_pending)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """Cancel the calls that have not started."""
        self._pool.shutdown(wait=kind is None, cancel_futures=True)

    def __iter__(self) -> Iterator[Result]:
        """Yield the results in the order of the arguments."""
        while self._pending:
            result = self._pending[0].result()
            # The result stays pending until the next call is submitted: an interrupt does not lose it.
            self._submit(1)
            self._pending.popleft()
            yield result

    def finished(self) -> Iterator[Result]:
        """Yield the finished results that were not yet returned, in the order of the arguments."""
        for future in self._pending:
            if future.done() and not future.cancelled():
                yield future.result()

    def _submit(self, count: int) -> None:
        arguments = islice(self._arguments, count)
        self._pending.extend(self._pool.submit(self._work, argument) for argument in arguments)


def map_on_threads(
    work: Callable[[Argument], Result], arguments: Iterable[Argument], *, jobs: int
) -> Iterator[Result]:
    """Yield the result of `work` for each argument, computed on `jobs` threads, in the order given."""
    with ThreadedMap(work, arguments, jobs=jobs) as results:
        yield from results


def shortest_cycle(cases: Iterable[scenario.Case]) -> float:
    """Return the shortest controller cycle of cases, s: a recording at this interval has every command."""
    return min((float(case.scenario.controller.cycle_time) for case in cases), default=math.inf)


def replay(
    cases: Sequence[scenario.Case], *, every: float, jobs: int
) -> Iterator[tuple[scenario.Case, recording.Recording]]:
    """Yield each case with its recording, a sample `every` so many seconds, in the order of the cases."""

    def simulated(together: Sequence[scenario.Case]) -> list[rig.SimulatedStop]:
        identified = [bench.identified(case) for case in together]
        if identified[0].train is not None:
            return rig.simulate_cars(identified, every)
        return [rig.simulate(case, record_every=every) for case in identified]

    stops = map_on_threads(simulated, trains_in(cases), jobs=jobs)
    for case, stop in zip(cases, chain.from_iterable(stops), strict=True):
        if stop.recording is not None:
            yield case, stop.recording


NOT_JUDGED: Final = ("error", "skipped")
"""Outcomes that do not follow from a verdict."""
PartsOfCases = Mapping[str, Mapping[str, "evaluation.EffectivePart"]]
"""Case id -> role -> part."""


def parts_of_cases(cases: Sequence[scenario.Case]) -> PartsOfCases:
    """Return the parts of simulated stops; a part that many cases share is computed once.

    A compensation that is to be identified is, in up to minutes: those parts are what the stop is run with.
    """
    parts = {}
    for case in cases:
        # Where nothing can be identified, the stop says why.
        with suppress(ValueError):
            case = bench.identified(case)
        parts[case.id] = evaluation.effective_parts(case.scenario)
    return parts


def parts_of_recorded(cases: Sequence[scenario.Case]) -> PartsOfCases:
    """Return the parts that recorded stops are judged with: conditions, measures and criteria, no rig."""
    return {case.id: evaluation.recorded_parts(case.scenario) for case in cases}


@dataclass(frozen=True, slots=True)
class RunSettings:
    """How cases are run, and what their results say besides.

    Args:
        jobs: number of threads.
        recording: the cases to record.
        maxfail: number of missed cases after which no further case is reported, so that the results do not
            depend on `jobs`.
        in_process: whether controllers from outside run in this process, which they can then crash.
        real_time: whether their cycles are paced by the clock; all must be programs at a socket.
        strict: whether a case is met only if all of its verdicts are settled, too, and it is firm where that
            was asked.
        firm: whether it is asked how firm all verdicts are; None: of the scenarios that say `firm`.
        calibration: stops by which the varied numbers are known, where it is asked how firm verdicts are.
        firmness: returns how firm the verdicts of the case of an id are, None where that was not asked.
        parts: effective parts by case id.
        domains: whether cases, by id, lie in the domain of a validation; of those for which it was asked.
        cars: figures of the cars of simulated cases, by id.

    """

    jobs: int = 1
    recording: RecordingRequest = field(default_factory=RecordingRequest)
    maxfail: int | None = None
    in_process: bool = False
    real_time: bool = False
    strict: bool = False
    firm: bool | None = None
    calibration: Sequence[scenario.Case] = ()
    firmness: Callable[[str], evaluation.Firmness | None] | None = None
    parts: PartsOfCases = field(default_factory=dict)
    domains: Mapping[str, evaluation.DomainOfValidity] = field(default_factory=dict)
    cars: Mapping[str, scenario.CarFigures] = field(default_factory=dict)

    def asks_firmness_of(self, case: scenario.Case) -> bool:
        """Return whether it is asked how firm the verdicts of a case are."""
        return case.scenario.firm if self.firm is None else self.firm

    def completed(self, result: evaluation.CaseResult) -> evaluation.CaseResult:
        """Return the result of a case with what it says besides: its parts, domain, car and `strict`."""
        return replace(
            result,
            parts=self.parts.get(result.id, {}),
            domain_of_validity=self.domains.get(result.id),
            strict=self.strict,
            car=self.cars.get(result.id),
        )


@dataclass(slots=True)
class BatchResult(Generic[Result]):
    """The results of cases, or of series, in their order, and whether an interrupt left some out."""

    results: list[Result] = field(default_factory=list)
    interrupted: bool = False

    def whole(self) -> list[Result]:
        """Return the results of all. Raises KeyboardInterrupt where an interrupt left some out."""
        if self.interrupted:
            raise KeyboardInterrupt
        return self.results


def run_cases(
    cases: Sequence[scenario.Case],
    settings: RunSettings | None = None,
    *,
    on_case: Callable[[CaseRun], None] = lambda case_run: None,
    on_stop: Callable[[], None] = lambda: None,
) -> BatchResult[evaluation.CaseResult]:
    """Run the cases on threads, and return the results in the order of the cases.

    The stops of a case that repeats its stop run side by side as well. A KeyboardInterrupt ends the batch;
    the results of cases all of whose stops are finished are kept.

    Args:
        cases: to run.
        settings: how to run them.
        on_case: called in this thread, once per case, in the order of the cases.
        on_stop: called in this thread, once per stop.
    """
    settings = settings or RunSettings()
    batch, own = BatchResult[evaluation.CaseResult](), settings

    def report(case_run: CaseRun) -> None:
        result = own.completed(case_run.result)
        try:
            if own.firmness is not None and result.outcome not in NOT_JUDGED:
                result = replace(result, firmness=own.firmness(result.id))
        finally:  # a case that an interrupt leaves without it is finished all the same
            batch.results.append(result)
            on_case(case_run._replace(result=result))

    with rig.Workers(keep_output=settings.recording.keep_output is not None) as workers:
        run: rig.RunInputs = rig.run_in_process if settings.in_process else workers.run
        run = rig.in_real_time(run) if settings.real_time else run
        of_train = rig.run_train_in_process if settings.in_process else workers.run_train

        def run_together(block: Block) -> Sequence[StopRun]:
            return run_block(block, settings.recording, run, of_train)

        blocks = blocks_of(cases, settings.recording, settings.jobs)
        stop_runs = ThreadedMap(run_together, blocks, jobs=settings.jobs)
        assembly = CaseAssembly(settings.recording)
        try:
            with stop_runs:
                missed = 0
                for case_run in _completed_cases(stop_runs, assembly, on_stop):
                    report(case_run)
                    missed += not batch.results[-1].met
                    if missed == settings.maxfail:
                        break
        except KeyboardInterrupt:
            batch.interrupted = True
            own = replace(own, firmness=None)
            # Before the child processes end: their stops would come out as errors.
            for case_run in _completed_cases(stop_runs.finished(), assembly, on_stop):
                report(case_run)
            controllers.interrupt_turns()
    return batch


def judge_cases(
    cases: Iterable[scenario.Case],
    judge: Callable[[scenario.Case], CaseRun],
    settings: RunSettings,
    on_case: Callable[[CaseRun], None],
) -> BatchResult[evaluation.CaseResult]:
    """Return the results of recorded cases, which `judge` judges one after the other."""
    batch = BatchResult[evaluation.CaseResult]()
    for case_run in map(judge, cases):
        batch.results.append(settings.completed(case_run.result))
        on_case(case_run._replace(result=batch.results[-1]))
    return batch


def _completed_cases(
    stop_runs: Iterable[Sequence[StopRun]], assembly: CaseAssembly, on_stop: Callable[[], None]
) -> Iterator[CaseRun]:
    """Yield each case once its last stop is there; at the end those that an interrupt kept from that."""
    for stop_run in chain.from_iterable(stop_runs):
        assembly.add(stop_run)
        on_stop()
        yield from assembly.complete()
    yield from assembly.complete()
