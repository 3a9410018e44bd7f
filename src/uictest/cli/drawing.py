"""The stops that a page of a run draws: recorded on the way where all are drawn, else the worst once more."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from uictest import campaign
from uictest.campaign import Campaign, Examined, RecordingWish

if TYPE_CHECKING:
    from uictest.report.page import Trace
    from uictest.scenario import Case


@dataclass(slots=True)
class Drawing:
    """Collects the traces of a batch.

    A batch of few cases is recorded as it runs. Of a large one the cases to draw are only known at its end;
    they are simulated again, which is cheap beside the batch. So are those of a batch whose recordings are
    too coarse for the valves: a page shows every command.
    """

    cases: Sequence[Case]
    wish: RecordingWish
    wanted: bool
    traces: dict[str, Trace] = field(default_factory=dict)

    @property
    def recording(self) -> RecordingWish:
        """What to record while the batch runs."""
        return replace(self.wish, cases="all") if self._on_the_way else self.wish

    def take(self, examined: Examined) -> None:
        """Keep what is drawn of a case."""
        from uictest.report.page import trace_of

        if self._on_the_way and examined.recording is not None:
            self.traces[examined.result.id] = trace_of(examined.recording)

    def finish(self, done: Campaign, jobs: int) -> dict[str, Trace]:
        """Return what there is to draw, the worst cases of a large batch simulated again."""
        from uictest.report.page import DRAWN, trace_of, worst_first

        if self.wanted and not self._on_the_way and not done.interrupted:
            worst = [result.id for result in worst_first(done.results) if result.outcome != "error"]
            chosen = campaign.by_id(self.cases, frozenset(worst[:DRAWN]))
            for case, recording in campaign.replay(chosen, every=self._interval, jobs=jobs):
                self.traces[case.id] = trace_of(recording)
        return self.traces

    @property
    def _on_the_way(self) -> bool:
        from uictest.report.page import DRAWN

        return self.wanted and len(self.cases) <= DRAWN and self.wish.every <= self._interval

    @property
    def _interval(self) -> float:
        """Time between two samples of what is drawn, s."""
        return min(self.wish.every, campaign.shortest_cycle(self.cases))
