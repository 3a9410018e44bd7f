"""A quantity of a study, and its value in its band as a small drawing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from statistics import median
from typing import Final, Literal, get_args

Status = Literal["calibrated", "selected", "by construction", "predicted"]
"""What a value is worth as evidence.

`calibrated`: it was a target of the calibration, or a number was set by hand with it in view. `selected`: it
is the best of a search, or something was chosen while it was watched. `by construction`: it follows from what
was put in. `predicted`: nothing was fitted to it; of our own model.
"""
Result = Literal["holds", "misses", "shown"]
"""`shown`: there is no band, the value is only shown."""
STATUSES: Final[tuple[Status, ...]] = get_args(Status)
RESULTS: Final[tuple[Result, ...]] = get_args(Result)

NOT_PUBLIC = "not public"
"""Replaces the paper's value where its text gives none."""
NOT_ASKED = "not asked"
"""Replaces the paper's value where only we ask the question."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Band:
    """Values that hold: an :class:`OwnBand` or a :class:`SourceBand`.

    Args:
        lower: least value that holds; itself excluded where `above` is set.
        upper: greatest value that holds; itself excluded where `below` is set.
        above, below: whether the value must stay above the lower, below the upper bound.
        reason: where the band comes from.
    """

    lower: float | None = None
    upper: float | None = None
    above: bool = False
    below: bool = False
    reason: str

    def contains(self, value: float) -> bool:
        """Return whether a value lies in the band; NaN never does."""
        above_lower = self.lower is None or value > self.lower or (value == self.lower and not self.above)
        below_upper = self.upper is None or value < self.upper or (value == self.upper and not self.below)
        return above_lower and below_upper and not math.isnan(value)


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnBand(Band):
    """A band that we chose, also one about a number of the paper: the study fails where it misses."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SourceBand(Band):
    """A band that the paper states for its own method or test; ours may miss it, if that is declared.

    Args:
        declared_miss: why ours misses it; empty where it holds. A declared miss that holds fails the study,
            so that declarations stay true.
    """

    reason: str = "paper"
    declared_miss: str = ""


@dataclass(frozen=True, slots=True)
class StudyQuantity:
    """A quantity that is compared with the paper, in the unit in which it is shown.

    Args:
        key: its name in files.
        title: its name for people.
        unit: unit of all its values; empty for a pure number.
        paper: its value in the text of Lee and Kang (2015), in words.
        status: what it is worth as evidence.
        band: in which it must lie; None where it is only shown.
        digits: digits shown behind the decimal point.
    """

    key: str
    title: str
    unit: str = ""
    paper: str = NOT_PUBLIC
    _: KW_ONLY
    status: Status
    band: OwnBand | SourceBand | None = None
    digits: int = 1

    def result(self, value: float) -> Result:
        """Return whether a value lies in the band."""
        if self.band is None:
            return "shown"
        return "holds" if self.band.contains(value) else "misses"

    @property
    def declared_miss(self) -> str:
        """Why the band of the paper is missed; empty where that is not declared."""
        return self.band.declared_miss if isinstance(self.band, SourceBand) else ""


@dataclass(frozen=True, slots=True)
class StudyValue:
    """A value of a study: one value, or the median of repeats with the least and the greatest of them."""

    value: float
    low: float | None = None
    high: float | None = None


def spread(values: Sequence[float]) -> StudyValue:
    """Return the median of repeats with their range; NaN where there is none, or a NaN is among them."""
    if not values or any(value != value for value in values):
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
    def result(self) -> Result:
        """Whether our value, of repeats the median, lies in the band."""
        return self.quantity.result(self.ours.value)

    @property
    def is_declared_miss(self) -> bool:
        """Whether it misses and that is declared; a value that is not a number is never declared."""
        declared = bool(self.quantity.declared_miss) and not math.isnan(self.ours.value)
        return declared and self.result == "misses"

    @property
    def fails(self) -> bool:
        """Whether the study fails by it: a miss that is not declared, or a declared miss that holds."""
        if self.quantity.declared_miss:
            return not self.is_declared_miss
        return self.result == "misses"


WIDTH: Final = 170
HEIGHT: Final = 22
_MARGIN: Final = 0.12
"""Free share of the width on both sides of what is drawn."""


@dataclass(frozen=True, slots=True)
class BandPlot:
    """Places across, pixels: a side of the band without a limit ends at the edge. `low`, `high`: repeats."""

    band: tuple[float, float]
    value: float
    low: float | None
    high: float | None
    holds: bool


def band_plot(comparison: PaperComparison) -> BandPlot | None:
    """Return the drawing of a quantity; None without a band or without a value."""
    band, ours = comparison.quantity.band, comparison.ours
    if band is None or not math.isfinite(ours.value):
        return None
    limits = [limit for limit in (band.lower, band.upper) if limit is not None]
    ends = [end for end in (ours.low, ours.high) if end is not None and math.isfinite(end)]
    # Zero is a limit of its own for a share or a difference that must stay below a bound.
    natural = [0.0] if band.lower is None and ours.value >= 0.0 else []
    shown = [*limits, *ends, *natural, ours.value]
    least, span = min(shown), (max(shown) - min(shown)) or abs(ours.value) or 1.0

    def across(value: float) -> float:
        return round(WIDTH * (_MARGIN + (1.0 - 2.0 * _MARGIN) * (value - least) / span), 1)

    return BandPlot(
        band=(
            0.0 if band.lower is None else across(band.lower),
            float(WIDTH) if band.upper is None else across(band.upper),
        ),
        value=across(ours.value),
        low=across(ends[0]) if len(ends) == 2 else None,
        high=across(ends[1]) if len(ends) == 2 else None,
        holds=comparison.result == "holds",
    )
