"""The stops that a page of a run draws: recorded on the way where all are drawn, else the worst once more."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from uictest import campaign, report, scenario
from uictest.report import page


@dataclass(slots=True)
class Drawing:
    """Collects the traces of a batch.

    A batch of few cases is recorded as it runs. Of a large one the cases to draw are only known at its end;
    they are simulated again, which is cheap beside the batch. So are those of a batch whose recordings are
    too coarse for the valves: a page shows every command.
    """

    cases: Sequence[scenario.Case]
    wish: campaign.RecordingRequest
    wanted: bool
    traces: dict[str, report.Trace] = field(default_factory=dict)

    @property
    def recording(self) -> campaign.RecordingRequest:
        """What to record while the batch runs."""
        return replace(self.wish, cases="all") if self._on_the_way else self.wish

    def take(self, examined: campaign.CaseRun) -> None:
        """Keep what is drawn of a case."""
        if self._on_the_way and examined.recording is not None:
            self.traces[examined.result.id] = report.trace_of(examined.recording, examined.result.criteria)

    def finish(self, done: campaign.BatchResult, jobs: int) -> dict[str, report.Trace]:
        """Return what there is to draw, the worst cases of a large batch simulated again."""
        if self.wanted and not self._on_the_way and not done.interrupted:
            ranked = [result for result in page.worst_first(done.results) if result.outcome != "error"]
            worst = {result.id: result for result in ranked[: page.DRAWN]}
            drawn_cases = campaign.by_id(self.cases, frozenset(worst))
            for case, recording in campaign.replay(drawn_cases, every=self._interval, jobs=jobs):
                self.traces[case.id] = report.trace_of(recording, worst[case.id].criteria)
        return self.traces

    @property
    def _on_the_way(self) -> bool:
        return self.wanted and len(self.cases) <= page.DRAWN and self.wish.every <= self._interval

    @property
    def _interval(self) -> float:
        """Time between two samples of what is drawn, s."""
        return min(self.wish.every, campaign.shortest_cycle(self.cases))
