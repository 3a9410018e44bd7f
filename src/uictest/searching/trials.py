"""The stops of a search: simulated in batches, remembered, and kept in a file from which a search goes on."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Final, NamedTuple

from uictest import rig
from uictest.core import files
from uictest.judging.evaluation import CaseResult, guiding_margin
from uictest.plans.scenario import ScenarioErrors
from uictest.plans.search import Point, Space
from uictest.running.campaign import ThreadedMap
from uictest.running.chunked import ManyStops, PlannedCase, RunBlock
from uictest.runs import InvalidInputError

ERROR: Final = "error"
"""In place of a criterion: the controller fails, as by a crash."""
REFUSED: Final = "refused"
"""Outcome of a stop that cannot be run: its values do not fit together."""
_NOISES: Final = ("nominal", "own")


class Stop(NamedTuple):
    """A stop at a point under one of its seeds, from 0.

    With `own_noise` it is the stop that a scenario file with these values runs; else it meets the noise of
    the nominal stop, so that a small change of a value makes a small change of the margin.
    """

    point: Point
    seed: int = 0
    own_noise: bool = False


class Trial(NamedTuple):
    """What a stop came to: its outcome, and its margin to each target; NaN where that is not judged.

    The margin to ERROR is -1 where the controller fails, else 1 where the stop was run.
    """

    outcome: str
    margins: tuple[float, ...]

    @classmethod
    def of(cls, outcome: str, margins: Iterable[float]) -> Trial:
        """Return what a stop with an outcome and margins to the criteria came to."""
        return cls(outcome, (*margins, {ERROR: -1.0, REFUSED: math.nan}.get(outcome, 1.0)))


@dataclass
class Trials:
    """Runs the stops of a search, each once.

    Args:
        space: that the stops lie in.
        jobs: number of threads; the results do not depend on it.
        run_block: simulates stops with controllers from outside.
        file: to which each finished stop is appended; one that is there already is not run again. None: none.
        simulated: stops so far.

    Raises InvalidInputError where the file has a row that is no stop of this search.

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
        content = self.file.read_bytes() if self.file.exists() else b""
        whole = content[: content.rfind(b"\n") + 1].decode("utf-8-sig", "replace") or _csv_text(
            [self._headings]
        )
        files.write_to(self.file, whole)
        rows = csv.reader(io.StringIO(whole))
        try:
            if next(rows) != self._headings:
                raise ValueError(f"not the columns {','.join(self._headings)}")
            for row in rows:
                self._read_row(row)
        except (ValueError, csv.Error) as error:
            hint = "remove the line, or search anew without --resume"
            raise InvalidInputError(f"--resume: {self.file}:{rows.line_num}: {error}; {hint}") from error

    def _read_row(self, row: Sequence[str]) -> None:
        if len(row) != len(self._headings):
            raise ValueError(f"{len(row)} values for {len(self._headings)} columns")
        seed, noise, *point = row[: 2 + len(self.space.columns)]
        outcome, *margins = row[2 + len(point) :]
        stop = Stop(tuple(point), int(seed), bool(_NOISES.index(noise)))
        self._of_before[stop] = Trial.of(outcome, [float(text or math.nan) for text in margins])

    @property
    def targets(self) -> tuple[str, ...]:
        """The criteria, and behind them that the controller fails."""
        return (*self.space.search.criteria, ERROR)

    def run(self, stops: Iterable[Stop]) -> list[Trial]:
        """Return what stops come to; those that were not run before are, all at once."""
        asked = list(stops)
        new = [stop for stop in dict.fromkeys(asked) if stop not in self._known]
        missing = [stop for stop in new if stop not in self._of_before]
        tried = dict(zip(missing, map(self.trial, self.simulate(missing)), strict=True))
        if self.file is not None and tried:
            files.append(self.file, _csv_text(self._row(stop, trial) for stop, trial in tried.items()))
        for stop in new:
            self._known[stop] = trial = tried.get(stop) or self._of_before[stop]
            self.simulated += trial.outcome != REFUSED
        return [self._known[stop] for stop in asked]

    def simulate(self, stops: Sequence[Stop]) -> list[CaseResult | None]:
        """Return the results of stops; None for one that cannot be run."""
        results: dict[str, CaseResult] = {}
        for own_noise, many in enumerate(self._with_nominal_and_own_noise):
            planned: list[PlannedCase] = []
            for index, stop in enumerate(stops):
                if stop.own_noise == own_noise:
                    with suppress(ScenarioErrors):
                        case = self.space.case(stop.point, stop.seed)
                        planned.append(PlannedCase(replace(case, id=str(index))))
            shares = [planned[k :: self.jobs] for k in range(min(self.jobs, len(planned)))]
            with ThreadedMap(many.results, shares, jobs=self.jobs) as done:
                results |= {result.id: result for of_share, _ in done for result in of_share}
        return [results.get(str(index)) for index in range(len(stops))]

    @cached_property
    def _with_nominal_and_own_noise(self) -> tuple[ManyStops, ManyStops]:
        nominal = ManyStops((), self.run_block, noise_of=self.space.loaded.case)
        return nominal, ManyStops((), self.run_block)

    def trial(self, result: CaseResult | None) -> Trial:
        """Return what a result comes to; an error that is not of the controller refuses the stop."""
        criteria = self.space.search.criteria
        if result is None or result.outcome == ERROR:
            failed = result is not None and result.reason.startswith("controller:")
            return Trial.of(ERROR if failed else REFUSED, [math.nan] * len(criteria))
        return Trial.of(result.outcome, (guiding_margin(result, criterion) for criterion in criteria))

    @cached_property
    def _headings(self) -> list[str]:
        margins = (f"margin {criterion}" for criterion in self.space.search.criteria)
        return ["seed", "noise", *self.space.columns, "outcome", *margins]

    def _row(self, stop: Stop, trial: Trial) -> list[str]:
        margins = ("" if math.isnan(each) else repr(each) for each in trial.margins[:-1])
        return [str(stop.seed), _NOISES[stop.own_noise], *stop.point, trial.outcome, *margins]


def _csv_text(rows: Iterable[Sequence[str]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def kth_margin(margins: Sequence[float], needed: int, stops: int) -> float:
    """Return the margin that decides whether a share `needed` of `stops` fails: negative if so.

    Of fewer margins it is the one at the same share of them. NaN counts as no failure, infinitely far.
    """
    known = sorted(math.inf if math.isnan(margin) else margin for margin in margins)
    return known[math.ceil(needed * len(known) / stops) - 1]
