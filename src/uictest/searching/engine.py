"""The search itself: random points, then differential evolution; what looks bad is run under more seeds."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from uictest.plans.search import NOMINAL, Point
from uictest.plans.sweeps import sobol_blocks
from uictest.searching.trials import ERROR, REFUSED, Stop, Trials, kth_margin

Progress = Callable[[int, float], None]
"""Is called with the number of stops, and the smallest margin of any criterion that is to be found; negative:
what was found is made small."""


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
        judged: criterion -> random points that it judged.
        refused: points that could not be run.

    """

    found: dict[str, list[Point]] = field(default_factory=dict)
    found_after: dict[str, int] = field(default_factory=dict)
    margins: dict[str, float] = field(default_factory=dict)
    random: int = 0
    judged: dict[str, int] = field(default_factory=dict)
    refused: int = 0

    @property
    def largest_share(self) -> dict[str, float]:
        """Criterion that was not found -> share of the space that fails it at most, with 95 % confidence."""
        return {name: 1.0 - 0.05 ** (1.0 / n) for name, n in self.judged.items() if name not in self.found}


@dataclass
class Engine:
    """Looks for points that fail.

    Args:
        trials: runs the stops.
        progress: hears of it.
        guided: whether half of the stops follow the margins; else all points are random.
        wanted: targets to find; empty: all.
        columns: that vary, all others are nominal; None: all vary.
        findings: what it has come to.
        vectors: those of the points that were tried.

    """

    block: ClassVar[int] = 64
    """Random points that are run at once; chosen: enough for the lanes of several threads."""
    population: ClassVar[int] = 32
    """Points of a generation; chosen."""
    patience: ClassVar[int] = 12
    """Generations without a better point after which evolution begins anew, elsewhere; chosen."""
    farthest: ClassVar[float] = 0.3
    """Radius around a point, over the ranges, in which others like it are looked for; chosen."""
    nearest: ClassVar[float] = 0.03
    """The smallest radius, over the largest; chosen."""
    few: ClassVar[int] = 3
    """Found points of one criterion that are kept; chosen."""

    trials: Trials
    progress: Progress = lambda stops, margin: None
    guided: bool = True
    wanted: Sequence[str] = ()
    columns: Sequence[int] | None = None
    findings: Findings = field(default_factory=Findings)
    vectors: dict[Point, NDArray[np.float64]] = field(default_factory=dict)
    _values: dict[Point, list[float]] = field(default_factory=dict)

    def run(self) -> Findings:
        """Search until every criterion is found, or the stops are used up."""
        search = self.trials.space.search
        self._search_at_random(search.stops // 2 if self.guided else search.stops)
        criteria = [target for target in self._open if target != ERROR and self.guided]
        for number, criterion in enumerate(criteria):
            left = search.stops - self.trials.simulated
            self._follow(criterion, self.trials.simulated + left // (len(criteria) - number))
        return self.findings

    def found_near(self, vector: NDArray[np.float64], columns: Sequence[int], target: str) -> list[Point]:
        """Return points that fail near a vector, all columns but some being nominal."""
        others = [k for k in range(len(vector)) if k not in columns]
        beyond = {point: each for point, each in self._values.items() if any(point[k] for k in others)}
        narrowed = replace(self, findings=Findings(), wanted=(target,), columns=columns, _values=beyond)
        narrowed.progress = lambda stops, margin: self.progress(stops, -1.0)
        draws = np.random.default_rng([self.trials.space.search.seed, *columns])
        radii = self.farthest * self.nearest ** draws.random((3 * self.population, 1))
        near = np.clip(vector + radii * draws.uniform(-1.0, 1.0, (len(radii), len(vector))), 0.0, 1.0)
        for block in np.split(near, 3):
            if narrowed._open:
                narrowed._try_vectors(block)
        return narrowed.findings.found.get(target, [])

    @property
    def _open(self) -> list[str]:
        """The targets that are not found yet."""
        return [name for name in self.wanted or self.trials.targets if name not in self.findings.found]

    def _search_at_random(self, stops: int) -> None:
        space = self.trials.space
        count = 1 << max(stops - 1, 1).bit_length()
        vectors = sobol_blocks(1, count, len(space.columns), space.search.seed)
        for first in range(0, count, self.block):
            block = vectors[first : first + min(self.block, stops - self.trials.simulated)]
            if self._open in ([], [ERROR]) or not len(block):
                return
            for margins in self._try_vectors(block):
                self.findings.random += margins[-1] < math.inf  # to ERROR: finite where a stop was run
                for name, margin in zip(space.search.criteria, margins, strict=False):
                    if margin < math.inf:
                        self.findings.judged[name] = self.findings.judged.get(name, 0) + 1

    def _follow(self, target: str, stops: int) -> None:
        """Follow the margin to one target until it is found, or so many stops are simulated."""
        restart, unchanged = 0, 0
        while target in self._open and self.trials.simulated < stops and unchanged <= self.patience:
            before = self.trials.simulated
            self._evolve(target, stops, restart)
            restart, unchanged = restart + 1, unchanged + 1 if self.trials.simulated == before else 0

    def _evolve(self, target: str, stops: int, restart: int) -> None:
        """Let one population evolve, which begins with the best points, later ones with those after them."""
        from scipy.optimize import differential_evolution

        index = self.trials.targets.index(target)
        best, since_best = math.inf, 0

        def margins(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
            nonlocal best, since_best
            left = max(stops - self.trials.simulated, 0)
            values = np.full(vectors.shape[1], math.inf)
            values[:left] = [of_point[index] for of_point in self._try_vectors(vectors.T[:left])]
            since_best = 0 if values.min() < best else since_best + 1
            best = min(best, float(values.min()))
            if target not in self._open or self.trials.simulated >= stops or since_best > self.patience:
                raise _EndedError
            return values

        try:
            differential_evolution(
                margins,
                [(0.0, 1.0)] * len(self.trials.space.columns),
                init=self._first_population(index, restart),
                maxiter=stops,
                tol=0.0,
                rng=np.random.default_rng(self.trials.space.search.seed + restart),
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
        best = [self.vectors[point] for point in ranked[restart * size : (restart + 1) * size]]
        search, dimensions = self.trials.space.search, len(self.trials.space.columns)
        generator = np.random.default_rng([search.seed, target, restart])
        return np.array([*best, *generator.random((self.population - len(best), dimensions))])

    def _point(self, vector: NDArray[np.float64]) -> Point:
        point = self.trials.space.point(vector.tolist())
        if self.columns is None:
            return point
        return tuple(text if column in self.columns else NOMINAL for column, text in enumerate(point))

    def _try_vectors(self, vectors: NDArray[np.float64]) -> list[list[float]]:
        """Return the margins of points to all targets, infinite where they cannot be run."""
        points = [self._point(vector) for vector in vectors]
        for point, vector in zip(points, vectors, strict=True):
            self.vectors.setdefault(point, vector.copy())
        self._race([point for point in dict.fromkeys(points) if point not in self._values])
        smallest = [self.findings.margins.get(name, math.inf) for name in self._open if name != ERROR]
        self.progress(self.trials.simulated, min(smallest, default=-1.0))
        unknown = [math.inf] * len(self.trials.targets)
        return [self._values[point] or unknown for point in points]

    def _race(self, points: Sequence[Point]) -> None:
        """Run points under one seed, failing and best ones under two, those that still fail under all."""
        seeds = self.trials.space.search.fails_in.stops
        runnable = self._settled(points, 1)
        promising = [point for point in runnable if self._failed_by(point)]
        for index in range(len(self.trials.targets) - 1):
            promising += sorted(runnable, key=lambda point: self._values[point][index])[:1]
        for point in self._settled(dict.fromkeys(promising), min(2, seeds)):
            if self._failed_by(point) and self._settled([point], seeds, own_noise=True):
                for target in self._failed_by(point):
                    self.findings.found.setdefault(target, []).append(point)
                    self.findings.found_after.setdefault(target, self.trials.simulated)
        for point in runnable:
            for name, value in zip(self.trials.space.search.criteria, self._values[point], strict=False):
                self.findings.margins[name] = min(self.findings.margins.get(name, math.inf), value)

    def _settled(self, points: Iterable[Point], seeds: int, *, own_noise: bool = False) -> list[Point]:
        """Run points under so many seeds, keep the margins that decide, and return those that can be run."""
        points, fails_in = list(points), self.trials.space.search.fails_in
        trials = iter(
            self.trials.run(Stop(each, seed, own_noise) for each in points for seed in range(seeds))
        )
        for point in points:
            of_point = list(itertools.islice(trials, seeds))
            refused = any(trial.outcome == REFUSED for trial in of_point)
            margins = zip(*(trial.margins for trial in of_point), strict=True)
            self._values[point] = [] if refused else [kth_margin(each, *fails_in) for each in margins]
            self.findings.refused += refused
        return [point for point in points if self._values[point]]

    def _failed_by(self, point: Point) -> list[str]:
        """Return the targets by which a point fails: those that are wanted, and of which few are known."""
        wanted, known = self.wanted or self.trials.targets, self.findings.found
        named = zip(self.trials.targets, self._values[point], strict=False)
        failed = [target for target, value in named if value < 0.0 and target in wanted]
        return [target for target in failed if len(known.get(target, ())) < self.few]
