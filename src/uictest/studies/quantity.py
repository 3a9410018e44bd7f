"""A figure that a study finds, what the source says of it, and the band it must lie in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median
from typing import Literal

BandStatus = Literal["holds", "misses", "shown"]
"""`shown`: no band was set, the figure is only shown."""

NOT_PUBLIC = "not public"
"""What stands in for the source's figure where its text gives none."""
NOT_ASKED = "not asked"
"""What stands there where the question is ours alone."""


@dataclass(frozen=True, slots=True)
class StudyQuantity:
    """What is compared, in the unit in which it is shown.

    Args:
        key: its name in files.
        title: its name for people.
        unit: unit of all its figures; empty for a pure number.
        source: what the text of Lee and Kang (2015) says of it, in words.
        lower: least value that holds, itself included.
        upper: greatest value that holds; itself excluded where `below` is set.
        below: whether the value must stay below the upper bound.
        digits: digits shown behind the decimal point.
        reason: where the band comes from.
    """

    key: str
    title: str
    unit: str = ""
    source: str = NOT_PUBLIC
    lower: float | None = None
    upper: float | None = None
    below: bool = False
    digits: int = 1
    reason: str = ""

    def verdict(self, value: float) -> BandStatus:
        """Return whether a value lies in the band. NaN never does."""
        if self.lower is None and self.upper is None:
            return "shown"
        above_lower = self.lower is None or value >= self.lower
        below_upper = self.upper is None or value < self.upper or (value == self.upper and not self.below)
        return "holds" if above_lower and below_upper else "misses"


@dataclass(frozen=True, slots=True)
class FoundValue:
    """A figure as found: one value, or the median of repeats with the least and the greatest of them."""

    value: float
    low: float | None = None
    high: float | None = None


def spread(values: Sequence[float]) -> FoundValue:
    """Return the median of repeats with their range; a NaN among them makes all three NaN."""
    if any(value != value for value in values):
        return FoundValue(float("nan"), float("nan"), float("nan"))
    return FoundValue(float(median(values)), float(min(values)), float(max(values)))


def repeats_note(repeats: int) -> str:
    """Return the sentence that says what a spread over seeds is."""
    return f"Median and range of {repeats} stops that differ in the noise of the sensors."


@dataclass(frozen=True, slots=True)
class PaperComparison:
    """Source beside here."""

    quantity: StudyQuantity
    found: FoundValue

    @property
    def verdict(self) -> BandStatus:
        """Whether the value, of repeats the median, lies in the band."""
        return self.quantity.verdict(self.found.value)
