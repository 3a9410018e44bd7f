"""The stops that the page of a run draws: recorded while they run, or the worst simulated again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from uictest import campaign, evaluation, recording, report, scenario
from uictest.report import page
from uictest.runs.processors import available_processors


@dataclass(slots=True)
class TraceCollection:
    """Collects the traces of a batch.

    A small batch is recorded while it runs. The cases to draw of a large batch are known only at its end:
    they are simulated again, which is cheap compared with the batch. So are those of a batch whose recordings
    are too coarse for the valves, because a page shows every command. Stops with controllers from outside are
    not `repeatable`: all are recorded while they run, and the traces of the worst are kept.
    """

    cases: Sequence[scenario.Case]
    request: campaign.RecordingRequest
    needed: bool
    repeatable: bool = True
    traces: dict[str, report.PlotTrace] = field(default_factory=dict)

    @classmethod
    def of(
        cls, cases: Sequence[scenario.Case], request: campaign.RecordingRequest, *, needed: bool
    ) -> TraceCollection:
        """Return the collection for some cases."""
        return cls(cases, request, needed, are_repeatable(cases))

    @property
    def recording(self) -> campaign.RecordingRequest:
        """What to record while the batch runs."""
        return replace(self.request, cases="all") if self._while_running else self.request

    def add(self, case_run: campaign.CaseRun) -> None:
        """Add the trace of a case."""
        if self._while_running and case_run.recording is not None:
            self.traces[case_run.result.id] = report.trace_of(
                case_run.recording, case_run.result.drawn_stop.criteria
            )

    def finish(self, done: campaign.BatchResult, jobs: int) -> dict[str, report.PlotTrace]:
        """Return the traces; simulate the worst cases of a large batch again."""
        worst = _worst(done.results)
        if not self.repeatable:
            self.traces = {name: trace for name, trace in self.traces.items() if name in worst}
        if self.needed and not self._while_running and not done.interrupted:
            self.traces |= _simulated_again(self.cases, worst, self._interval, jobs)
        return self.traces

    @property
    def _while_running(self) -> bool:
        small_and_fine = len(self.cases) <= page.DRAWN and self.request.every <= self._interval
        return self.needed and (small_and_fine or not self.repeatable)

    @property
    def _interval(self) -> float:
        return _interval(self.cases, self.request.every)


def with_traces(
    content: report.RunContent,
    cases: Sequence[scenario.Case],
    recordings: Mapping[str, recording.Recording],
    every: float,
) -> report.RunContent:
    """Return a finished run with what a page draws of it: the worst stops, simulated again.

    Of stops that are not repeatable, and without `cases`, it draws those that were recorded.

    Args:
        content: what reports show of the run.
        cases: of the run.
        recordings: of some of them, by id.
        every: the interval of these, s.
    """
    worst = _worst(content.all_results)
    if cases and are_repeatable(cases):
        traces = _simulated_again(cases, worst, _interval(cases, every), available_processors())
    else:
        traces = {
            name: report.trace_of(recordings[name], result.drawn_stop.criteria)
            for name, result in worst.items()
            if name in recordings
        }
    return replace(content, traces=traces)


def are_repeatable(cases: Sequence[scenario.Case]) -> bool:
    """Return whether the stops of cases come out the same again: no controller is from outside."""
    return all(case.scenario.controller.program is None for case in cases)


def _worst(results: Sequence[evaluation.CaseResult]) -> dict[str, evaluation.CaseResult]:
    """Return the cases that a page draws, by id."""
    ranked = [result for result in page.worst_first(results) if result.outcome != "error"]
    return {result.id: result for result in ranked[: page.DRAWN]}


def _interval(cases: Sequence[scenario.Case], every: float) -> float:
    """Return the time between two samples of what is drawn, s."""
    return min(every, campaign.shortest_cycle(cases))


def _simulated_again(
    cases: Sequence[scenario.Case], drawn: Mapping[str, evaluation.CaseResult], every: float, jobs: int
) -> dict[str, report.PlotTrace]:
    return {
        case.id: report.trace_of(samples, drawn[case.id].drawn_stop.criteria)
        for case, samples in campaign.replay(campaign.by_id(cases, frozenset(drawn)), every=every, jobs=jobs)
    }
