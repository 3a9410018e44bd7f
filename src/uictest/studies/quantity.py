"""A quantity of a study: its value, the text of the paper, and the band in which it must lie."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median
from typing import Literal

BandStatus = Literal["holds", "misses", "shown"]
"""`shown`: there is no band, the value is only shown."""

NOT_PUBLIC = "not public"
"""Replaces the paper's value where its text gives none."""
NOT_ASKED = "not asked"
"""Replaces the paper's value where only we ask the question."""


@dataclass(frozen=True, slots=True)
class StudyQuantity:
    """A quantity that is compared with the paper, in the unit in which it is shown.

    Args:
        key: its name in files.
        title: its name for people.
        unit: unit of all its values; empty for a pure number.
        paper: its value in the text of Lee and Kang (2015), in words.
        lower: least value that holds, itself included.
        upper: greatest value that holds; itself excluded where `below` is set.
        below: whether the value must stay below the upper bound.
        digits: digits shown behind the decimal point.
        reason: where the band comes from.
    """

    key: str
    title: str
    unit: str = ""
    paper: str = NOT_PUBLIC
    lower: float | None = None
    upper: float | None = None
    below: bool = False
    digits: int = 1
    reason: str = ""

    def status(self, value: float) -> BandStatus:
        """Return whether a value lies in the band; NaN never does."""
        if self.lower is None and self.upper is None:
            return "shown"
        above_lower = self.lower is None or value >= self.lower
        below_upper = self.upper is None or value < self.upper or (value == self.upper and not self.below)
        return "holds" if above_lower and below_upper else "misses"


@dataclass(frozen=True, slots=True)
class StudyValue:
    """A value of a study: one value, or the median of repeats with the least and the greatest of them."""

    value: float
    low: float | None = None
    high: float | None = None


def spread(values: Sequence[float]) -> StudyValue:
    """Return the median of repeats with their range; a NaN among them makes all three NaN."""
    if any(value != value for value in values):
        return StudyValue(float("nan"), float("nan"), float("nan"))
    return StudyValue(float(median(values)), float(min(values)), float(max(values)))


def repeats_note(repeats: int) -> str:
    """Return the note on a spread over seeds."""
    return f"Median and range of {repeats} stops that differ in the noise of the sensors."


@dataclass(frozen=True, slots=True)
class PaperComparison:
    """The paper's value of a quantity (in words) and ours."""

    quantity: StudyQuantity
    ours: StudyValue

    @property
    def status(self) -> BandStatus:
        """Whether our value, of repeats the median, lies in the band."""
        return self.quantity.status(self.ours.value)
