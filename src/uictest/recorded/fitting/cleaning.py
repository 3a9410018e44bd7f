"""How sliding cleans the rail, found from one or several recorded stops together with the rail's friction.

The friction under a wheelset is mu0 + C (mur - mu0). C follows from the energy Wc and from the contact losses
per metre of the wheelsets that have passed. mu0 belongs to a stop and its stretches, mur and Wc to all stops.

Where C is small it is proportional to W / Wc, so that only (mur - mu0) / Wc shows; where C hardly varies it
cannot be told from mu0. So the misfit itself is asked what the record determines: whether no cleaning, or
another energy with the recovered friction that suits it best, fits as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from uictest.recorded.fitting.least_squares import Groups, Solution, solve
from uictest.recorded.fitting.stretches import HIGHEST, LOWEST, CleanedStop

Array = NDArray[np.float64]
CleaningStanding = Literal["found", "not told apart", "not seen", "nothing slid"]

LOWEST_ENERGY, HIGHEST_ENERGY = 10.0, 1e8
"""J/m between which the energy is sought; chosen."""
_STARTS = (0.3, 1.0, 3.0, 10.0)
"""Factors on the scenario's energy to begin with; chosen."""
WIDEST = 0.25
"""Half width of the 95 % confidence interval over the value from which it is not determined; chosen."""
_LEAST_GAIN = 9.2
"""Fall of chi square by which cleaning must improve the fit: 99 % confidence with two unknowns."""
_SMALLEST_RISE = 0.03
"""Share by which cleaning must have raised the friction of a rail to be seen; chosen."""
_BISECTIONS = 12
_FIRST_STEPS, _STEPS = 8, 30
"""Steps of least squares to choose where to begin, and from there; chosen."""


@dataclass(frozen=True, slots=True)
class CleaningEstimate:
    """How sliding cleans the rail: energy Wc in J/m and recovered friction mur, with 95 % half widths.

    `not told apart`: other pairs of both fit as well; the energy is then the one that belongs to the
    scenario's recovered friction. `not seen`: no cleaning fits as well; the energy is then the least that the
    record allows with the scenario's recovered friction. `nothing slid`: the record says nothing of it.

    `correlation` is that of the errors of ln energy and recovered friction, NaN where they are not found
    together; `largest_share` is the cleaned share of the cleanest rail under a sliding wheelset.
    """

    standing: CleaningStanding
    energy: float
    energy_half_width: float
    recovered_friction: float
    recovered_half_width: float
    correlation: float
    largest_share: float

    def __str__(self) -> str:
        """Return the estimate for a reader."""
        return "\n".join(_WORDS[self.standing](self))


def _found(e: CleaningEstimate) -> list[str]:
    energy = 100.0 * e.energy_half_width / e.energy
    recovered = 100.0 * e.recovered_half_width / e.recovered_friction
    value, friction = f"{e.energy:.0f} +- {e.energy_half_width:.0f} J/m", f"{e.recovered_friction:.4f}"
    return [
        f"energy that cleans the rail: {value} ({energy:.1f} %, 95 % confidence)",
        f"friction of the clean rail: {friction} +- {e.recovered_half_width:.4f} ({recovered:.1f} %)",
        f"cleanest rail under a sliding wheelset: {100.0 * e.largest_share:.0f} % clean",
    ]


def _not_told_apart(e: CleaningEstimate) -> list[str]:
    stated = f"with the scenario's recovered friction of {e.recovered_friction:g}"
    return [
        "energy and recovered friction cannot be told apart from this: other pairs fit as well",
        "give a stop with deeper slides, or several stops on rails of different friction",
        f"{stated} the energy would be {e.energy:.0f} +- {e.energy_half_width:.0f} J/m,",
        f"and the cleanest rail under a sliding wheelset {100.0 * e.largest_share:.0f} % clean",
    ]


def _not_seen(e: CleaningEstimate) -> list[str]:
    stated = f"with the scenario's recovered friction of {e.recovered_friction:g}"
    return [
        "cleaning is not seen: a rail that nothing cleans fits as well",
        f"{stated} the energy is at least {e.energy:.0f} J/m",
    ]


def _nothing_slid(_: CleaningEstimate) -> list[str]:
    return ["cleaning cannot be found: no wheelset slid long enough"]


_WORDS = {
    "found": _found,
    "not told apart": _not_told_apart,
    "not seen": _not_seen,
    "nothing slid": _nothing_slid,
}


@dataclass(frozen=True, slots=True, eq=False)
class JointSolution:
    """The cleaning found from several stops, and the friction of each: values and half widths."""

    cleaning: CleaningEstimate
    levels: tuple[list[float], ...]
    half_widths: tuple[list[float], ...]
    residual: float


def find_cleaning(stops: Sequence[CleanedStop], energy: float, recovered_friction: float) -> JointSolution:
    """Return energy and recovered friction common to stops, of which something slid in each.

    Args:
        stops: recorded stops.
        energy: of the scenario, to begin with, J/m.
        recovered_friction: of the scenario; also taken where both cannot be found.
    """
    joint = _Joint(tuple(stops))
    free = joint.best([factor * energy for factor in _STARTS], recovered_friction)
    bare = joint.solve(energy=np.inf, recovered=recovered_friction, noise=None)
    if not _is_seen(joint, free, bare):
        cleaning = _least_energy(joint, bare, recovered_friction)
    elif _is_determined(joint, free):
        cleaning = _estimate(joint, free)
    else:
        cleaning = _with_stated_friction(joint, free, recovered_friction)
    return JointSolution(cleaning, *joint.frictions(free), free.residual)


@dataclass(frozen=True, slots=True, eq=False)
class _Joint:
    """The unknowns of all stops, then ln energy and recovered friction as far as they are not given."""

    stops: tuple[CleanedStop, ...]

    def solve(
        self,
        energy: float | None = None,
        recovered: float | None = None,
        *,
        start: tuple[float, float] | None = None,
        near: Solution | None = None,
        noise: Sequence[float] | None,
        steps: int = _STEPS,
    ) -> Solution:
        """Return the solution with energy or recovered friction given, or begun with at `start`.

        The unknowns of the stops begin with those of a solution that is near.
        """
        first, second = start or (energy or 1.0, recovered or HIGHEST)
        begin = [v for stop in self.stops for v in stop.start]
        if near is not None:
            begin = near.values[: len(begin)].tolist()
        common = [np.log(first)] * (energy is None) + [second] * (recovered is None)
        lowest = [np.log(LOWEST_ENERGY)] * (energy is None) + [LOWEST] * (recovered is None)
        highest = [np.log(HIGHEST_ENERGY)] * (energy is None) + [HIGHEST] * (recovered is None)

        def residuals(x: Array) -> Groups:
            own, rest = x[: len(x) - len(common)], list(x[len(x) - len(common) :])
            w_c = float(np.exp(rest.pop(0))) if energy is None else energy
            mur = float(rest.pop()) if recovered is None else recovered
            return [group for stop, part in self._split(own) for group in stop.residuals(part, w_c, mur)]

        return solve(
            residuals,
            np.array([*begin, *common]),
            (
                [*(v for stop in self.stops for v in stop.bounds[0]), *lowest],
                [*(v for stop in self.stops for v in stop.bounds[1]), *highest],
            ),
            noise,
            lambda x: np.concatenate([stop.known(part) for stop, part in self._split(x)]),
            steps,
        )

    def best(self, energies: Sequence[float], recovered: float) -> Solution:
        """Return the solution from where different energies to begin with lead best."""
        start = [(energy, recovered) for energy in energies]
        tried = [self.solve(start=each, noise=None, steps=_FIRST_STEPS) for each in start]
        least = min(tried, key=lambda each: each.misfit)
        return self.solve(start=_pair(least), near=least, noise=None)

    def frictions(self, solution: Solution) -> tuple[tuple[list[float], ...], tuple[list[float], ...]]:
        """Return the friction of the free stretches of each stop, and the half widths."""
        values, widths = self._split(solution.values), self._split(np.array(solution.half_widths))
        return (
            tuple(list(map(float, part[: stop.levels])) for stop, part in values),
            tuple(list(map(float, part[: stop.levels])) for stop, part in widths),
        )

    def largest_share(self, solution: Solution, energy: float, recovered: float) -> float:
        """Return the cleaned share of the cleanest rail under a sliding wheelset."""
        return max(stop.largest_share(part, energy, recovered) for stop, part in self._split(solution.values))

    def rise(self, solution: Solution, energy: float, recovered: float) -> float:
        """Return by which share cleaning has raised the friction of a rail at most."""
        rises = [
            stop.largest_share(part, energy, recovered) * (recovered / part[: stop.levels].min() - 1.0)
            for stop, part in self._split(solution.values)
        ]
        return float(max(rises))

    def _split(self, x: Array) -> list[tuple[CleanedStop, Array]]:
        ends = np.cumsum([len(stop.start) for stop in self.stops])
        return list(zip(self.stops, np.split(x, ends)[: len(self.stops)], strict=True))


def _pair(solution: Solution) -> tuple[float, float]:
    return float(np.exp(solution.values[-2])), float(solution.values[-1])


def _is_seen(joint: _Joint, free: Solution, bare: Solution) -> bool:
    """Return whether cleaning fits better than none, by an amount that matters."""
    gain = 2.0 * (bare.misfit - free.misfit) / free.dependence
    return gain > _LEAST_GAIN and joint.rise(free, *_pair(free)) > _SMALLEST_RISE


def _is_determined(joint: _Joint, free: Solution) -> bool:
    """Return whether both are narrow, and no other energy fits with any recovered friction."""
    energy, recovered = _pair(free)
    *_, log_width, width = free.half_widths
    if log_width > WIDEST or width > WIDEST * recovered:
        return False
    others = [energy / (1.0 + WIDEST), energy * (1.0 + WIDEST)]
    costs = [joint.solve(energy=w, start=(w, recovered), near=free, noise=free.noise).cost for w in others]
    return min(costs) > free.cost + free.significance


def _estimate(joint: _Joint, free: Solution) -> CleaningEstimate:
    energy, recovered = _pair(free)
    *_, log_width, width = free.half_widths
    covariance = free.covariance[-2:, -2:]
    correlation = float(covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1]))
    share = joint.largest_share(free, energy, recovered)
    return CleaningEstimate("found", energy, energy * log_width, recovered, width, correlation, share)


def _with_stated_friction(joint: _Joint, free: Solution, recovered: float) -> CleaningEstimate:
    """Return the energy that belongs to the recovered friction of the scenario."""
    start = (_pair(free)[0], recovered)
    solution = joint.solve(recovered=recovered, start=start, near=free, noise=free.noise)
    energy, width = float(np.exp(solution.values[-1])), solution.half_widths[-1]
    share = joint.largest_share(solution, energy, recovered)
    nan = float("nan")
    return CleaningEstimate("not told apart", energy, energy * width, recovered, nan, nan, share)


def _least_energy(joint: _Joint, bare: Solution, recovered: float) -> CleaningEstimate:
    """Return the least energy with which cleaning is not contradicted, by the solution without any."""
    low, high = np.log(LOWEST_ENERGY), np.log(HIGHEST_ENERGY)
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        energy = float(np.exp(middle))
        cost = joint.solve(energy=energy, recovered=recovered, near=bare, noise=bare.noise).cost
        contradicted = cost > bare.cost + bare.significance
        low, high = (middle, high) if contradicted else (low, middle)
    energy, nan = float(np.exp(high)), float("nan")
    share = joint.largest_share(bare, energy, recovered)
    return CleaningEstimate("not seen", energy, nan, recovered, nan, nan, share)
