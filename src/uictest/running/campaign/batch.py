"""Run many cases on threads; the compiled rig releases the interpreter's lock."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from uictest import controllers, rig
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.rig import bench
from uictest.running.campaign.stop import CaseAssembly, CaseRun, RecordingRequest, StopRun, run_stop, stops_of
from uictest.running.campaign.threaded_map import ThreadedMap

PartsOfCases = Mapping[str, Mapping[str, "evaluation.EffectivePart"]]
"""Case id -> role -> part."""


def parts_of_cases(cases: Sequence[scenario.Case]) -> PartsOfCases:
    """Return the parts of simulated stops; a part that many cases share is computed once.

    A compensation that is to be identified is: those parts are what the stop is run with.
    """
    effective = evaluation.EffectiveParts()
    return {case.id: effective.of(_as_run(case).scenario) for case in cases}


def _as_run(case: scenario.Case) -> scenario.Case:
    try:
        return bench.identified(case)
    except ValueError:  # nothing can be identified: the stop says why
        return case


def parts_of_recorded(cases: Sequence[scenario.Case]) -> PartsOfCases:
    """Return the parts that recorded stops are judged with: conditions, measures and criteria, no rig."""
    effective = evaluation.EffectiveParts()
    return {case.id: effective.of_recorded(case.scenario) for case in cases}


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
        strict: whether a case is met only if all of its verdicts are settled, too.
        parts: effective parts by case id.
        domains: whether cases, by id, lie in the domain of a validation; of those for which it was asked.

    """

    jobs: int = 1
    recording: RecordingRequest = field(default_factory=RecordingRequest)
    maxfail: int | None = None
    in_process: bool = False
    real_time: bool = False
    strict: bool = False
    parts: PartsOfCases = field(default_factory=dict)
    domains: Mapping[str, evaluation.DomainOfValidity] = field(default_factory=dict)

    def completed(self, result: evaluation.CaseResult) -> evaluation.CaseResult:
        """Return the result of a case with what it says besides: its parts, its domain and `strict`."""
        return replace(
            result,
            parts=self.parts.get(result.id, {}),
            domain_of_validity=self.domains.get(result.id),
            strict=self.strict,
        )


@dataclass(slots=True)
class BatchResult:
    """The results of a batch in the order of its cases, and whether the batch was interrupted."""

    results: list[evaluation.CaseResult] = field(default_factory=list)
    interrupted: bool = False

    def whole(self) -> list[evaluation.CaseResult]:
        """Return the results of all cases. Raises KeyboardInterrupt where an interrupt left some out."""
        if self.interrupted:
            raise KeyboardInterrupt
        return self.results


def run_cases(
    cases: Sequence[scenario.Case],
    settings: RunSettings | None = None,
    *,
    on_result: Callable[[CaseRun], None] = lambda case_run: None,
    on_stop: Callable[[], None] = lambda: None,
) -> BatchResult:
    """Run the cases on threads, and return the results in the order of the cases.

    The stops of a case that repeats its stop run side by side as well. A KeyboardInterrupt ends the batch;
    the results of cases all of whose stops are finished are kept.

    Args:
        cases: to run.
        settings: how to run them.
        on_result: called in this thread, once per case, in the order of the cases.
        on_stop: called in this thread, once per stop.
    """
    settings = settings or RunSettings()
    batch = BatchResult()

    def report(case_run: CaseRun) -> None:
        case_run = replace(case_run, result=settings.completed(case_run.result))
        batch.results.append(case_run.result)
        on_result(case_run)

    with rig.Workers() as workers:
        run: rig.RunInputs = rig.run_in_process if settings.in_process else workers.run
        run = rig.in_real_time(run) if settings.real_time else run
        stop_runs = ThreadedMap(
            lambda stop: run_stop(stop, settings.recording, run), stops_of(cases), jobs=settings.jobs
        )
        assembly = CaseAssembly(settings.recording)
        try:
            with stop_runs:
                missed = 0
                for case_run in _assembled(stop_runs, assembly, on_stop):
                    report(case_run)
                    missed += not batch.results[-1].met
                    if missed == settings.maxfail:
                        break
        except KeyboardInterrupt:
            batch.interrupted = True
            # Before the child processes end: their stops would come out as errors.
            for case_run in _assembled(stop_runs.finished(), assembly, on_stop):
                report(case_run)
            controllers.interrupt_turns()
    return batch


def judge_cases(
    cases: Iterable[scenario.Case],
    judge: Callable[[scenario.Case], CaseRun],
    settings: RunSettings,
    on_result: Callable[[CaseRun], None],
) -> BatchResult:
    """Return the results of recorded cases, which `judge` judges one after the other."""
    batch = BatchResult()
    for case_run in map(judge, cases):
        batch.results.append(settings.completed(case_run.result))
        on_result(replace(case_run, result=batch.results[-1]))
    return batch


def _assembled(
    stop_runs: Iterable[StopRun], assembly: CaseAssembly, on_stop: Callable[[], None]
) -> Iterator[CaseRun]:
    """Yield each case once its last stop is there; at the end those that an interrupt kept from that."""
    for stop_run in stop_runs:
        assembly.add(stop_run)
        on_stop()
        yield from assembly.complete()
    yield from assembly.complete()
