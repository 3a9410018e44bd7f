"""The stops of a search: simulated in batches, remembered, and kept in a file from which a search goes on."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Final, NamedTuple

from uictest import rig
from uictest.core import files
from uictest.judging.evaluation import CaseResult, guiding_margin
from uictest.plans.scenario import ScenarioErrors
from uictest.plans.search import Point, Space
from uictest.running.campaign import ThreadedMap
from uictest.running.chunked import ManyStops, PlannedCase, RunBlock

ERROR: Final = "error"
"""In place of a criterion: the controller fails, as by a crash."""
REFUSED: Final = "refused"
"""Outcome of a stop that cannot be run: its values do not fit together."""


class Stop(NamedTuple):
    """A stop at a point under one of its seeds, from 0.

    With `own_noise` it is the stop that a scenario file with these values runs; else it meets the noise of
    the nominal stop, so that a small change of a value makes a small change of the margin.
    """

    point: Point
    seed: int = 0
    own_noise: bool = False


class Trial(NamedTuple):
    """What a stop came to: its outcome, and its margin to each target; NaN where that is not judged."""

    outcome: str
    margins: tuple[float, ...]


@dataclass
class Trials:
    """Runs the stops of a search, each once.

    Args:
        space: that the stops lie in.
        jobs: number of threads; the results do not depend on it.
        run_block: simulates stops with controllers from outside.
        file: to which each finished stop is appended; one that is there already is not run again. None: none.

    """

    space: Space
    jobs: int = 1
    run_block: RunBlock = rig.run_block
    file: Path | None = None
    simulated: int = 0
    _known: dict[Stop, Trial] = field(default_factory=dict)
    _of_before: dict[Stop, Trial] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Read the stops of a search that was interrupted, and drop a row that was not written to its end."""
        if self.file is None:
            return
        if not self.file.exists():
            files.append(self.file, self._csv_text([self._headings]))
            return
        text = self.file.read_text("utf-8")
        whole = text[: text.rfind("\n") + 1]
        if whole != text:
            files.write_to(self.file, whole)
        rows = list(csv.reader(io.StringIO(whole)))
        if not rows or rows[0] != self._headings:
            raise ValueError(f"{self.file} is of another search: its columns are others")
        self._of_before = dict(map(self._read_row, rows[1:]))

    @property
    def targets(self) -> tuple[str, ...]:
        """The criteria, and behind them that the controller fails."""
        return (*self.space.search.criteria, ERROR)

    def run(self, stops: Iterable[Stop]) -> list[Trial]:
        """Return what stops come to; those that were not run before are, all at once."""
        asked = list(stops)
        new = [stop for stop in dict.fromkeys(asked) if stop not in self._known]
        missing = [stop for stop in new if stop not in self._of_before]
        results = [_trial(result, self.targets) for result in self.simulate(missing)]
        tried = dict(zip(missing, results, strict=True))
        if self.file is not None and missing:
            rows = [self._row(stop, tried[stop]) for stop in missing]
            files.append(self.file, self._csv_text(rows))
        for stop in new:
            self._known[stop] = trial = tried.get(stop) or self._of_before[stop]
            self.simulated += trial.outcome != REFUSED
        return [self._known[stop] for stop in asked]

    def simulate(self, stops: Sequence[Stop]) -> list[CaseResult | None]:
        """Return the results of stops; None for one that cannot be run."""
        results: dict[int, CaseResult] = {}
        for own_noise, many in ((False, self._with_nominal_noise), (True, self._with_own_noise)):
            planned: list[PlannedCase] = []
            for index, stop in enumerate(stops):
                if stop.own_noise == own_noise:
                    with suppress(ScenarioErrors):
                        case = self.space.case(stop.point, stop.seed)
                        planned.append(PlannedCase(replace(case, id=str(index))))
            results |= {int(result.id): result for result in self._results(many, planned)}
        return [results.get(index) for index in range(len(stops))]

    def _results(self, many: ManyStops, planned: Sequence[PlannedCase]) -> Iterator[CaseResult]:
        """Yield the results of cases, an equal share of which runs on each thread."""
        count = min(self.jobs, len(planned))
        parts = [planned[number::count] for number in range(count)]
        with ThreadedMap(lambda part: many.results(part)[0], parts, jobs=self.jobs) as done:
            for of_part in done:
                yield from of_part

    @cached_property
    def _with_own_noise(self) -> ManyStops:
        return ManyStops((), self.run_block)

    @cached_property
    def _with_nominal_noise(self) -> ManyStops:
        return ManyStops((), self.run_block, noise_of=self.space.loaded.case)

    @property
    def _headings(self) -> list[str]:
        margins = (f"margin {target}" for target in self.targets[:-1])
        return ["seed", "noise", *self.space.columns, "outcome", *margins]

    def _row(self, stop: Stop, trial: Trial) -> list[str]:
        noise = "own" if stop.own_noise else "nominal"
        margins = ("" if math.isnan(each) else repr(each) for each in trial.margins[:-1])
        return [str(stop.seed), noise, *stop.point, trial.outcome, *margins]

    def _read_row(self, row: Sequence[str]) -> tuple[Stop, Trial]:
        end = 2 + len(self.space.columns)
        margins = tuple(float(text) if text else math.nan for text in row[end + 1 :])
        stop = Stop(tuple(row[2:end]), int(row[0]), row[1] == "own")
        return stop, Trial(row[end], (*margins, _error_margin(row[end])))

    @staticmethod
    def _csv_text(rows: Iterable[Sequence[str]]) -> str:
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows(rows)
        return text.getvalue()


def _trial(result: CaseResult | None, targets: Sequence[str]) -> Trial:
    """Return what a result comes to; an error that is not of the controller refuses the stop."""
    if result is None or (result.outcome == "error" and not result.reason.startswith("controller:")):
        return Trial(REFUSED, (math.nan,) * len(targets))
    failed = result.outcome == "error"
    margins = (math.nan if failed else guiding_margin(result, target) for target in targets[:-1])
    return Trial(result.outcome, (*margins, _error_margin(result.outcome)))


def _error_margin(outcome: str) -> float:
    return -1.0 if outcome == ERROR else math.nan


def kth_margin(margins: Sequence[float], needed: int, stops: int) -> float:
    """Return the margin that decides whether a share `needed` of `stops` fails: negative if so.

    Of fewer margins it is the one at the same share of them. NaN counts as no failure, infinitely far.
    """
    known: Any = sorted(math.inf if math.isnan(margin) else margin for margin in margins)
    return float(known[math.ceil(needed * len(known) / stops) - 1])
