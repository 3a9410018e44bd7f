"""The stops that the page of a run draws: recorded while they run, or the worst simulated again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from uictest import campaign, report, scenario
from uictest.report import page


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
        ranked = [result for result in page.worst_first(done.results) if result.outcome != "error"]
        worst = {result.id: result for result in ranked[: page.DRAWN]}
        if not self.repeatable:
            self.traces = {name: trace for name, trace in self.traces.items() if name in worst}
        if self.needed and not self._while_running and not done.interrupted:
            drawn_cases = campaign.by_id(self.cases, frozenset(worst))
            for case, recording in campaign.replay(drawn_cases, every=self._interval, jobs=jobs):
                self.traces[case.id] = report.trace_of(recording, worst[case.id].drawn_stop.criteria)
        return self.traces

    @property
    def _while_running(self) -> bool:
        small_and_fine = len(self.cases) <= page.DRAWN and self.request.every <= self._interval
        return self.needed and (small_and_fine or not self.repeatable)

    @property
    def _interval(self) -> float:
        """Time between two samples of what is drawn, s."""
        return min(self.request.every, campaign.shortest_cycle(self.cases))
