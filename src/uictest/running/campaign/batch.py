"""Run many cases on threads; the compiled rig releases the interpreter's lock."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from uictest import controllers, rig
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.rig import bench
from uictest.running.campaign.case import CaseRun, RecordingRequest, run_case
from uictest.running.campaign.repeats import CaseAssembly, Stop, StopRun, run_repeat, stops_of
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


def with_parts(case_run: CaseRun, parts: PartsOfCases) -> CaseRun:
    """Return the run of a case with its parts in the result."""
    result = case_run.result
    return replace(case_run, result=replace(result, parts=parts.get(result.id, {})))


def with_domain(case_run: CaseRun, domains: Mapping[str, evaluation.DomainOfValidity]) -> CaseRun:
    """Return the run of a case with what is known of it and of the domain of a validation in the result."""
    result = case_run.result
    return replace(case_run, result=replace(result, domain_of_validity=domains.get(result.id)))


@dataclass(slots=True)
class BatchResult:
    """The results of a batch in the order of its cases, and whether the batch was interrupted."""

    results: list[evaluation.CaseResult] = field(default_factory=list)
    interrupted: bool = False


def run_cases(
    cases: Sequence[scenario.Case],
    *,
    jobs: int = 1,
    recording: RecordingRequest | None = None,
    maxfail: int | None = None,
    parts: PartsOfCases | None = None,
    domains: Mapping[str, evaluation.DomainOfValidity] | None = None,
    in_process: bool = False,
    real_time: bool = False,
    strict: bool = False,
    on_result: Callable[[CaseRun], None] = lambda case_run: None,
    on_stop: Callable[[], None] = lambda: None,
) -> BatchResult:
    """Run the cases on `jobs` threads, and return the results in the order of the cases.

    The stops of a case that repeats its stop run side by side as well. A KeyboardInterrupt ends the batch;
    the results of cases all of whose stops are finished are kept.

    Args:
        cases: to run.
        jobs: number of threads.
        recording: the cases to record [default: those that miss their expectation].
        maxfail: number of missed cases after which no further case is reported, so that the results do not
            depend on `jobs`.
        parts: effective parts by case id, which are added to the results.
        domains: whether each case, by id, lies in the domain of a validation; added likewise.
        in_process: whether controllers from outside run in this process, which they can then crash.
        real_time: whether their cycles are paced by the clock; all must be programs at a socket.
        strict: whether a case is met only if all of its verdicts are settled, too.
        on_result: called in this thread, once per case, in the order of the cases.
        on_stop: called in this thread, once per stop.
    """
    batch = BatchResult()
    request = recording or RecordingRequest()

    def report(case_run: CaseRun) -> None:
        case_run = with_domain(with_parts(case_run, parts or {}), domains or {})
        case_run = replace(case_run, result=replace(case_run.result, strict=strict))
        batch.results.append(case_run.result)
        on_result(case_run)

    with rig.Workers() as workers:
        run = _runner(workers, in_process=in_process, real_time=real_time)
        stop_runs = ThreadedMap(lambda stop: _run_stop(stop, request, run), stops_of(cases), jobs=jobs)
        assembly = CaseAssembly(request)
        try:
            with stop_runs:
                _report_until(maxfail, _assembled(stop_runs, assembly, on_stop), report)
        except KeyboardInterrupt:
            batch.interrupted = True
            # Before the child processes end: their stops would come out as errors.
            for case_run in _assembled(stop_runs.finished(), assembly, on_stop):
                report(case_run)
            controllers.interrupt_turns()
    return batch


def _run_stop(stop: Stop, request: RecordingRequest, run: rig.RunInputs) -> StopRun:
    if stop.case.scenario.repeat > 1:
        return run_repeat(stop, request, run)
    return StopRun(stop, run_case(stop.case, request, run))


def _assembled(
    stop_runs: Iterable[StopRun], assembly: CaseAssembly, on_stop: Callable[[], None]
) -> Iterator[CaseRun]:
    """Yield each case once its last stop is there; at the end those that an interrupt kept from that."""
    for stop_run in stop_runs:
        assembly.add(stop_run)
        on_stop()
        yield from assembly.complete()
    yield from assembly.complete()


def _runner(workers: rig.Workers, *, in_process: bool, real_time: bool) -> rig.RunInputs:
    run: rig.RunInputs = rig.run_in_process if in_process else workers.run
    return rig.in_real_time(run) if real_time else run


def _report_until(
    maxfail: int | None,
    case_runs: Iterable[CaseRun],
    report: Callable[[CaseRun], None],
) -> None:
    missed = 0
    for case_run in case_runs:
        report(case_run)
        missed += not case_run.result.met
        if missed == maxfail:
            return
