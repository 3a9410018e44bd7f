"""The real train's stop: its four figures, and families of assumptions about what is not known of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import inf, isfinite
from types import MappingProxyType
from typing import Final, Literal

from uictest.units import KILOMETRE_PER_HOUR

DRY: Final = 0.30
"""No wheelset slides at this friction, whatever the pads: more friction changes nothing."""
Shape = Literal["constant", "dry first", "dry last"]
"""Friction along the track: the same everywhere, or slippery beyond a place or up to it."""
SHAPES: Final[tuple[Shape, ...]] = ("constant", "dry first", "dry last")
Brake = Literal["ep-disc", "distributor"]
"""A brake system of the library."""


@dataclass(frozen=True, slots=True)
class Assumptions:
    """One set of assumptions.

    Args:
        shape: of the friction along the track.
        friction: of the slippery track as it is found.
        place: where the friction changes, m from the brake command; without meaning where it is constant.
        brake: the brake system, which gives the dead time.
        fill_time: in which its pressure builds up, s.
        pad_factor: pad friction over the rig's: the paper does not give the brake force of the real train.
        cleaning_energy: that cleans the rail, J/m; None: sliding does not clean it.
        carry_over: of what a wheelset has cleaned, the share that the next one finds.
        lead: time from the brake command to the start of the clock, s.
    """

    shape: Shape
    friction: float
    place: float
    brake: Brake
    fill_time: float
    pad_factor: float = 1.0
    cleaning_energy: float | None = None
    carry_over: float = 0.0
    lead: float = 0.0

    def __str__(self) -> str:
        """Return the assumptions in words."""
        parts = [
            self._rail(),
            f"pads x {self.pad_factor:.2f}",
            f"{self.brake}, {self.fill_time:.1f} s to fill",
        ]
        if self.cleaning_energy is not None:
            energy = f"{self.cleaning_energy / 1e3:.1f} kJ/m"
            parts.insert(1, f"cleaned at {energy} with carry-over {self.carry_over:g}")
        if self.lead:
            parts.append(f"commanded {self.lead:.2f} s before the clock starts")
        return ", ".join(parts)

    def _rail(self) -> str:
        friction = f"friction {self.friction:.3f}"
        if self.shape == "constant":
            return f"{friction} everywhere"
        dry = f"dry {'up to' if self.shape == 'dry first' else 'beyond'} {self.place:.0f} m"
        return f"{dry}, {friction} {'beyond' if self.shape == 'dry first' else 'before'}"


@dataclass(frozen=True, slots=True)
class Range:
    """From where to where an assumption is varied, SI."""

    low: float
    high: float

    def at(self, share: float) -> float:
        """Return the value at a share of the range."""
        return self.low + share * (self.high - self.low)

    def near(self, value: float, shares: float) -> float:
        """Return the value that lies so many shares of the range from another, or the end of the range."""
        return min(max(value + shares * (self.high - self.low), self.low), self.high)


RAIL: Final[Mapping[str, Range]] = MappingProxyType(
    {"friction": Range(0.05, 0.20), "place": Range(30.0, 190.0)}
)
PADS: Final = MappingProxyType({"pad_factor": Range(1.0, 1.3)})
CLEANING: Final[Mapping[str, Range]] = MappingProxyType({"cleaning_energy": Range(2650.0, 21200.0)})
"""From half the energy of the library's rail to four times it."""
CARRY_OVERS: Final = (0.0, 0.5, 1.0)
DISTRIBUTOR: Final = MappingProxyType({"fill_time": Range(3.0, 5.0)})
"""The filling times of UIC 540 for positions P and R, known second-hand."""
ANY_BUILD_UP: Final = MappingProxyType({"fill_time": Range(0.8, 5.0)})
LEAD: Final = MappingProxyType({"lead": Range(0.0, 1.0)})
EVENLY: Final = 7
MANY: Final = 8
"""Of the families with one assumption more."""
_BRAKES: Final[tuple[tuple[str, Brake, Mapping[str, Range]], ...]] = (
    ("ep-disc", "ep-disc", MappingProxyType({})),
    ("distributor", "distributor", DISTRIBUTOR),
    ("build-up free", "ep-disc", ANY_BUILD_UP),
)


@dataclass(frozen=True, slots=True)
class Family:
    """Assumptions that share brake and cleaning.

    Args:
        name: in files.
        title: for people.
        brake: the brake system.
        ranges: of what is varied; the rest is as the library has it.
        cleans: whether sliding cleans the rail.
        evenly: power of two of the number of assumptions that are spread evenly over it.
    """

    name: str
    title: str
    brake: Brake
    ranges: Mapping[str, Range]
    cleans: bool = False
    evenly: int = EVENLY


def _families() -> Iterator[Family]:
    yield Family("library", "library's ep-disc", "ep-disc", RAIL)
    for title, brake, build_up in _BRAKES:
        ranges, name = {**RAIL, **PADS, **build_up}, title.replace(" ", "-")
        evenly = MANY if "fill_time" in build_up else EVENLY
        yield Family(name, title, brake, ranges, evenly=evenly)
        cleaned = {**ranges, **CLEANING}
        yield Family(f"{name}-cleaned", f"{title}, cleaned", brake, cleaned, cleans=True, evenly=evenly)
    early = {**RAIL, **PADS, **DISTRIBUTOR, **LEAD}
    yield Family("distributor-early", "distributor, earlier command", "distributor", early, evenly=MANY)


FAMILIES: Final = tuple(_families())
"""In order of the number of assumptions that each adds."""


REAL_TRAIN: Final = MappingProxyType(
    {
        "braking_time": 17.6,
        "braking_distance": 197.0,
        "minimum_deceleration": 0.98,
        "maximum_deceleration": 1.52,
    }
)
"""Stated by Lee and Kang (2015): s, m, m/s2, m/s2."""
INITIAL_SPEED: Final = 80.0 * KILOMETRE_PER_HOUR
"""Stated by them, too, m/s."""
TOLERANCES: Final = MappingProxyType(
    {"braking_time": 0.35, "braking_distance": 4.0, "minimum_deceleration": 0.1, "maximum_deceleration": 0.1}
)
"""Chosen: 2 % of time and distance, and the possible effect of the unknown filter of the decelerations."""
RUN: Final = ("braking_time", "braking_distance")


@dataclass(frozen=True, slots=True)
class FieldStop:
    """What a stop of the rig gives beside the real train's.

    Args:
        figures: the measures of :data:`REAL_TRAIN`, SI; NaN where the train did not stop.
        actuations: of the WSP valve of each wheelset.
        largest_slide: of any wheelset, share.
    """

    figures: Mapping[str, float]
    actuations: tuple[int, ...]
    largest_slide: float

    @property
    def misfits(self) -> dict[str, float]:
        """The difference of each figure from the real train's, in tolerances; infinite if there is none."""
        return {name: _misfit(name, self.figures[name]) for name in REAL_TRAIN}

    @property
    def misfit(self) -> float:
        """The largest of the misfits."""
        return max(self.misfits.values())

    @property
    def agrees(self) -> bool:
        """Whether all four figures lie within their tolerances."""
        return self.misfit <= 1.0

    @property
    def agrees_in_run(self) -> bool:
        """Whether time and distance lie within their tolerances."""
        return max(self.misfits[name] for name in RUN) <= 1.0


def _misfit(name: str, figure: float) -> float:
    off = abs(figure - REAL_TRAIN[name]) / TOLERANCES[name]
    return off if isfinite(off) else inf


def even_braking_delay() -> float:
    """Return the delay, s, after which an even deceleration takes the real train's time and distance.

    T = v / a + delay and D = v (T + delay) / 2.
    """
    return 2.0 * REAL_TRAIN["braking_distance"] / INITIAL_SPEED - REAL_TRAIN["braking_time"]
