"""The stops that the page of a run draws: recorded while they run, or the worst simulated again."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

from uictest import report
from uictest.core import recording
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.running import campaign
from uictest.runs.observer import available_processors


@dataclass(slots=True)
class TraceCollection:
    """Collects the traces of a batch.

    A small batch is recorded while it runs. The cases to draw of a large batch are known only at its end:
    they are simulated again, which is cheap compared with the batch. So are those of a batch whose recordings
    are too coarse for the valves, because a page shows every command. Stops with controllers from outside are
    not `repeatable`: all are recorded while they run, and the traces of those drawn are kept. Those that were
    `recorded` before have their traces anyway.
    """

    cases: Sequence[scenario.Case]
    request: campaign.RecordingRequest
    needed: bool
    repeatable: bool = True
    drawn_first: Collection[str] = ()
    recorded: bool = False
    traces: dict[str, report.PlotTrace] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        cases: Sequence[scenario.Case],
        request: campaign.RecordingRequest,
        drawn_first: Collection[str] = (),
        *,
        needed: bool,
        recorded: bool = False,
    ) -> TraceCollection:
        """Return the collection for some cases; those `drawn_first`, by id, are drawn before others."""
        return cls(cases, request, needed, recorded or are_repeatable(cases), drawn_first, recorded)

    @property
    def recording(self) -> campaign.RecordingRequest:
        """What to record while the batch runs."""
        if not self._while_running:
            return self.request
        return self.request._replace(cases="all", band_stops=report.BAND_STOPS)

    def add(self, case_run: campaign.CaseRun) -> None:
        """Add the trace of a case."""
        if self._while_running and case_run.recording is not None:
            trace = report.trace_of_stop(case_run.recording, case_run.result)
            self.traces[case_run.result.id] = report.with_band(trace, case_run.extremes)

    def finish(
        self, results: Sequence[evaluation.CaseResult], jobs: int, *, interrupted: bool
    ) -> dict[str, report.PlotTrace]:
        """Return the traces; simulate the drawn cases of a large batch again, unless it was interrupted."""
        drawn = _drawn(results, self.drawn_first)
        if not self.repeatable:
            self.traces = {name: trace for name, trace in self.traces.items() if name in drawn}
        if self.needed and not self._while_running and not interrupted:
            self.traces |= _simulated_again(self.cases, drawn, self._interval, jobs)
        return self.traces

    @property
    def _while_running(self) -> bool:
        small_and_fine = len(self.cases) <= report.DRAWN and self.request.every <= self._interval
        return self.needed and (small_and_fine or self.recorded or not self.repeatable)

    @property
    def _interval(self) -> float:
        return _interval(self.cases, self.request.every)


def with_traces(
    content: report.RunContent,
    cases: Sequence[scenario.Case],
    recordings: Mapping[str, recording.Recording],
    every: float,
) -> report.RunContent:
    """Return a finished run with what a page draws of it: some of its stops, simulated again.

    Of stops that are not repeatable, and without `cases`, it draws those that were recorded.

    Args:
        content: what reports show of the run.
        cases: of the run.
        recordings: of some of them, by id.
        every: the interval of these, s.
    """
    drawn = _drawn(content.all_results, content.drawn_first)
    if cases and are_repeatable(cases):
        traces = _simulated_again(cases, drawn, _interval(cases, every), available_processors())
    else:
        traces = {
            name: report.trace_of_stop(recordings[name], result)
            for name, result in drawn.items()
            if name in recordings
        }
    return replace(content, traces=traces)


def are_repeatable(cases: Sequence[scenario.Case]) -> bool:
    """Return whether the stops of cases come out the same again: no controller is from outside."""
    return not any(case.is_from_outside for case in cases)


def _drawn(
    results: Sequence[evaluation.CaseResult], drawn_first: Collection[str]
) -> dict[str, evaluation.CaseResult]:
    """Return the cases that a page draws, by id."""
    stopped = [result for result in results if result.outcome != "error"]
    return {result.id: result for result in report.drawn_cases(stopped, drawn_first)}


def _interval(cases: Sequence[scenario.Case], every: float) -> float:
    """Return the time between two samples of what is drawn, s."""
    return min(every, campaign.shortest_cycle(cases))


def _simulated_again(
    cases: Sequence[scenario.Case], drawn: Mapping[str, evaluation.CaseResult], every: float, jobs: int
) -> dict[str, report.PlotTrace]:
    """Return the traces; of a repeated case the first stop is drawn, before the band of those that follow."""
    stops = [
        stop.alone
        for stop in campaign.stops_of(campaign.by_id(cases, frozenset(drawn)))
        if stop.place < report.BAND_STOPS
    ]
    traces: dict[str, report.PlotTrace] = {}
    extremes: dict[str, list[report.StopExtremes]] = {}
    for case, samples in campaign.replay(stops, every=every, jobs=jobs):
        if case.id not in traces:
            traces[case.id] = report.trace_of_stop(samples, drawn[case.id])
        extremes.setdefault(case.id, []).append(report.stop_extremes(samples))
    return {case_id: report.with_band(trace, extremes[case_id]) for case_id, trace in traces.items()}
