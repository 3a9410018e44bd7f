"""Values of swept parameters: as written, or the interval of drawn numbers that cases are counted in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from pydantic import PlainSerializer, PlainValidator

_TO = " .. "
"""Between the ends of an interval."""


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
        """The unit behind the number; empty where there is none."""
        return self.text.partition(" ")[2]


@dataclass(frozen=True, slots=True)
class DrawnInterval:
    """An interval of drawn numbers; both ends in `unit`, which is empty for a pure number."""

    low: float
    high: float
    unit: str

    @property
    def label(self) -> str:
        """The interval as shown to users, e.g. `60 .. 70 %`."""
        return f"{self.low_text}{_TO}{self.high_text}"

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


def _read_value(text: object) -> WrittenValue | DrawnInterval:
    """Return the value with this JSON form: that of an interval is its label."""
    if not isinstance(text, str):
        raise ValueError("Input should be the text of a value")
    low, is_interval, high = text.partition(_TO)
    try:
        end, _, unit = high.partition(" ")
        return DrawnInterval(float(low), float(end), unit) if is_interval else WrittenValue(text)
    except ValueError:
        return WrittenValue(text)


def _read_written_value(text: object) -> WrittenValue:
    if not isinstance(text, str):
        raise ValueError("Input should be the text of a value")
    return WrittenValue(text)


def _label(value: WrittenValue | DrawnInterval) -> str:
    return value.label


SweptValue = Annotated[WrittenValue | DrawnInterval, PlainValidator(_read_value), PlainSerializer(_label)]
"""A value of a swept parameter; its JSON form is its label."""

Written = Annotated[WrittenValue, PlainValidator(_read_written_value), PlainSerializer(_label)]
"""A value as written; its JSON form is the text."""


def range_label(values: Sequence[SweptValue]) -> str:
    """Return the label of neighbouring values, e.g. `0.160 .. 0.165 (2 values)` or `60 .. 80 %`."""
    first, last = values[0], values[-1]
    if isinstance(first, DrawnInterval) and isinstance(last, DrawnInterval):
        return f"{first.low_text}{_TO}{last.high_text}"
    return first.label if len(values) == 1 else f"{first.label}{_TO}{last.label} ({len(values)} values)"
