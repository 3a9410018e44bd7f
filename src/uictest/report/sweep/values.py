"""Values of swept parameters: as written, or the interval of drawn numbers that cases are counted in."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, ClassVar, Final

from pydantic import ConfigDict, PlainSerializer, PlainValidator, TypeAdapter

from uictest.core.units import as_written

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class WrittenValue:
    """A value as a scenario has it, e.g. `80 km/h`, `0.12` or `one-caliper`."""

    text: str

    @property
    def label(self) -> str:
        """The value as shown to users."""
        return self.text

    @property
    def number(self) -> float | None:
        """The number in its unit, None where the value is not a number."""
        try:
            return float(self.text.split()[0])
        except (ValueError, IndexError):
            return None

    @property
    def unit(self) -> str:
        """The unit after the number; empty where there is none."""
        return self.text.partition(" ")[2]


@dataclass(frozen=True, slots=True)
class DrawnInterval:
    """An interval of drawn numbers; both ends in `unit`, which is empty for a pure number."""

    __pydantic_config__: ClassVar = ConfigDict(extra="forbid", defer_build=True)

    low: float
    high: float
    unit: str

    @property
    def label(self) -> str:
        """The interval as shown to users, e.g. `60 .. 70 %`."""
        return f"{self.low_text} .. {self.high_text}"

    @property
    def number(self) -> float:
        """The middle of the interval."""
        return (self.low + self.high) / 2.0

    @property
    def low_text(self) -> str:
        """The lower end without its unit."""
        return f"{self.low:.10g}"

    @property
    def high_text(self) -> str:
        """The upper end with its unit."""
        return f"{self.high:.10g} {self.unit}".rstrip()


def interval_indices(intervals: Sequence[DrawnInterval], numbers: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return in which of neighbouring intervals each of some numbers, in SI units, lies.

    A number at a boundary lies in the upper one: what converting it to the unit added to it does not count.
    """
    import numpy as np  # checking a sweep and reading its result do without

    unit = intervals[0].unit or "1"
    drawn = [as_written(number, unit) for number in numbers.tolist()]
    return np.searchsorted([interval.low for interval in intervals[1:]], drawn, side="right")


def _value_of(content: object) -> WrittenValue | DrawnInterval:
    """Return the value with this JSON form."""
    if isinstance(content, str):
        return WrittenValue(content)
    return _INTERVAL.validate_python(content)


def _json_form(value: WrittenValue | DrawnInterval) -> object:
    return value.text if isinstance(value, WrittenValue) else dataclasses.asdict(value)


def _written_value(text: object) -> WrittenValue:
    if not isinstance(text, str):
        raise ValueError("Input should be the text of a value")
    return WrittenValue(text)


_INTERVAL: Final = TypeAdapter(DrawnInterval)
SweptValue = Annotated[WrittenValue | DrawnInterval, PlainValidator(_value_of), PlainSerializer(_json_form)]
"""A value of a swept parameter; in JSON its text, or the `low`, `high` and `unit` of an interval."""
Written = Annotated[WrittenValue, PlainValidator(_written_value), PlainSerializer(_json_form)]
"""A value as written; its JSON form is the text."""


def range_label(values: Sequence[SweptValue]) -> str:
    """Return the label of neighbouring values, e.g. `0.160 .. 0.165 (2 values)` or `60 .. 80 %`."""
    first, last = values[0], values[-1]
    if isinstance(first, DrawnInterval) and isinstance(last, DrawnInterval):
        return f"{first.low_text} .. {last.high_text}"
    return first.label if len(values) == 1 else f"{first.label} .. {last.label} ({len(values)} values)"
