"""Families of assumptions: those that share a brake and a rail, each with its ranges."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from uictest.studies.field.assumptions import Brake


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
