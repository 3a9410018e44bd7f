"""The search itself: random points, then differential evolution; what looks bad is run under more seeds."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from uictest.plans.search import Point
from uictest.plans.sweeps import sobol_blocks
from uictest.searching.trials import REFUSED, Stop, Trials, kth_margin

Progress = Callable[[int, float], None]
"""Is called with the number of stops, and the smallest margin of any criterion that was not yet found."""


class _EndedError(Exception):
    """Differential evolution has nothing more to do."""


@dataclass
class Findings:
    """What a search has come to.

    Args:
        found: target -> points that fail, the first first.
        found_after: target -> stops that were simulated until it was found.
        margins: criterion -> smallest margin of a point under one or two seeds, or all if it was confirmed.
        random: random points that could be run.
        refused: points that could not.

    """

    found: dict[str, list[Point]] = field(default_factory=dict)
    found_after: dict[str, int] = field(default_factory=dict)
    margins: dict[str, float] = field(default_factory=dict)
    random: int = 0
    refused: int = 0

    @property
    def largest_share(self) -> float:
        """Share of the space that can fail at most, with 95 % confidence, if no random point did."""
        return 1.0 - 0.05 ** (1.0 / self.random) if self.random else 1.0


@dataclass
class Engine:
    """Looks for points that fail.

    Args:
        trials: runs the stops.
        progress: hears of it.
        guided: whether half of the stops follow the margins; else all points are random.

    """

    block: ClassVar[int] = 64
    """Random points that are run at once; chosen: enough for the lanes of several threads."""
    population: ClassVar[int] = 32
    """Points of a generation; chosen."""
    patience: ClassVar[int] = 12
    """Generations without a better point after which evolution begins anew, elsewhere; chosen."""
    few: ClassVar[int] = 3
    """Found points of one criterion that are kept; chosen."""

    trials: Trials
    progress: Progress = lambda stops, margin: None
    guided: bool = True
    findings: Findings = field(default_factory=Findings)
    _values: dict[Point, list[float]] = field(default_factory=dict)
    _vectors: dict[Point, NDArray[np.float64]] = field(default_factory=dict)

    def run(self) -> Findings:
        """Search until every criterion is found, or the stops are used up."""
        search = self.trials.space.search
        self._search_at_random(search.stops // 2 if self.guided else search.stops)
        open_criteria = self._open
        for number, criterion in enumerate(open_criteria):
            left = search.stops - self.trials.simulated
            self._follow(criterion, self.trials.simulated + left // (len(open_criteria) - number))
        return self.findings

    @property
    def _open(self) -> list[str]:
        """The criteria that are not found yet."""
        return [name for name in self.trials.space.search.criteria if name not in self.findings.found]

    def _search_at_random(self, stops: int) -> None:
        space = self.trials.space
        count = 1 << max(stops - 1, 1).bit_length()
        vectors = sobol_blocks(1, count, len(space.columns), space.search.seed)
        for first in range(0, count, self.block):
            block = vectors[first : first + min(self.block, stops - self.trials.simulated)]
            if not self._open or not len(block):
                return
            self._try_vectors(block)
            points = map(space.point, block)
            self.findings.random += sum(bool(self._values.get(point)) for point in points)

    def _follow(self, criterion: str, stops: int) -> None:
        """Follow the margin of one criterion until it is found, or so many stops are simulated."""
        restart = 0
        while self.guided and criterion in self._open and self.trials.simulated < stops:
            before = self.trials.simulated
            self._evolve(criterion, stops, restart)
            restart += 1
            if self.trials.simulated == before and restart > self.patience:
                return  # nothing new can be run

    def _evolve(self, criterion: str, stops: int, restart: int) -> None:
        """Let one population evolve, which begins with the best points, later ones with those after them."""
        from scipy.optimize import differential_evolution

        target = self.trials.targets.index(criterion)
        best, since_best = math.inf, 0

        def margins(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
            nonlocal best, since_best
            left = max(stops - self.trials.simulated, 0)
            values = np.full(vectors.shape[1], math.inf)
            values[:left] = [of_point[target] for of_point in self._try_vectors(vectors.T[:left])]
            since_best = 0 if values.min() < best else since_best + 1
            best = min(best, float(values.min()))
            if (
                criterion in self.findings.found
                or self.trials.simulated >= stops
                or since_best > self.patience
            ):
                raise _EndedError
            return values

        seed = self.trials.space.search.seed + restart
        try:
            differential_evolution(
                margins,
                [(0.0, 1.0)] * len(self.trials.space.columns),
                init=self._first_population(target, restart),
                maxiter=stops,
                tol=0.0,
                rng=np.random.default_rng(seed),
                polish=False,
                updating="deferred",
                vectorized=True,
            )
        except _EndedError:
            return

    def _first_population(self, target: int, restart: int) -> NDArray[np.float64]:
        """Return the points with the smallest margins that no population began with, and random ones."""
        runnable = [point for point, values in self._values.items() if values]
        ranked = sorted(runnable, key=lambda point: self._values[point][target])
        size = self.population * 3 // 4
        best = [self._vectors[point] for point in ranked[restart * size : (restart + 1) * size]]
        search, dimensions = self.trials.space.search, len(self.trials.space.columns)
        generator = np.random.default_rng([search.seed, target, restart])
        return np.array([*best, *generator.random((self.population - len(best), dimensions))])

    def _try_vectors(self, vectors: NDArray[np.float64]) -> list[list[float]]:
        """Return the margins of points to all targets, infinite where they cannot be run."""
        points = [self.trials.space.point(vector) for vector in vectors]
        for point, vector in zip(points, vectors, strict=True):
            self._vectors.setdefault(point, vector.copy())
        self._race([point for point in dict.fromkeys(points) if point not in self._values])
        smallest = [self.findings.margins.get(name, math.inf) for name in self._open]
        self.progress(self.trials.simulated, min(smallest, default=-1.0))
        unknown = [math.inf] * len(self.trials.targets)
        return [self._values[point] or unknown for point in points]

    def _race(self, points: Sequence[Point]) -> None:
        """Run points under one seed, failing and best ones under two, those that still fail under all."""
        if not points:
            return
        trials, seeds = self.trials, self.trials.space.search.fails_in.stops
        firsts = trials.run(Stop(point) for point in points)
        for point, trial in zip(points, firsts, strict=True):
            refused = trial.outcome == REFUSED
            self.findings.refused += refused
            self._values[point] = [] if refused else [kth_margin([each], 1, 1) for each in trial.margins]
        runnable = [point for point in points if self._values[point]]
        promising = [point for point in runnable if self._fails(point)]
        for target in range(len(trials.targets) - 1):
            promising += sorted(runnable, key=lambda point: self._values[point][target])[:1]
        self._settle(list(dict.fromkeys(promising)), min(2, seeds), own_noise=False)
        failing = [point for point in dict.fromkeys(promising) if self._fails(point)]
        self._settle(failing, seeds, own_noise=True)
        for point in runnable:
            self._note(point, is_confirmed=point in failing)

    def _settle(self, points: Sequence[Point], seeds: int, *, own_noise: bool) -> None:
        """Run points under so many seeds, and keep the margins that decide under these."""
        stops = [Stop(point, seed, own_noise) for point in points for seed in range(seeds)]
        margins = [trial.margins for trial in self.trials.run(stops)]
        for index, point in enumerate(points):
            of_point = margins[index * seeds : (index + 1) * seeds]
            needed = self.trials.space.search.fails_in
            self._values[point] = [kth_margin(each, *needed) for each in zip(*of_point, strict=True)]

    def _fails(self, point: Point) -> bool:
        """Return whether a point fails by a criterion that is not found yet, or by its controller."""
        named = zip(self.trials.targets, self._values[point], strict=True)
        return any(value < 0.0 and target not in self.findings.found for target, value in named)

    def _note(self, point: Point, *, is_confirmed: bool) -> None:
        """Take over the margins of a point, and what it shows where it fails under enough seeds."""
        for target, value in zip(self.trials.targets, self._values[point], strict=True):
            self.findings.margins[target] = min(self.findings.margins.get(target, math.inf), value)
            if value < 0.0 and is_confirmed:
                found = self.findings.found.setdefault(target, [])
                self.findings.found_after.setdefault(target, self.trials.simulated)
                if len(found) < self.few:
                    found.append(point)
