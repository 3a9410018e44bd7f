"""What a sweep varies: lists, ranges and distributions of values."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Final, Literal

from pydantic import BeforeValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from uictest.plans.scenario.yaml import (
    DecimalQuantity,
    DecimalQuantityField,
    Inconsistency,
    Model,
    common_unit,
    count_by_step,
)
from uictest.plans.scenario.yaml.quantity_field import field, optional

MOST_POINTS: Final = 2**24
FARTHEST_END: Final = 100_000
"""Deviations from the mean to the nearer end of a normal distribution, at most.

Farther off, the values keep to that end within 1e-10 of its distance, which ten digits do not tell apart.
"""
Method = Literal["random", "sobol", "latin-hypercube", "saltelli"]
_ONE_UNIT = "write all numbers of it with the same unit"


class Range(Model):
    """Numbers from the first to the last, given by a step or by their count."""

    first: DecimalQuantityField = field("First number, with its unit.")
    last: DecimalQuantityField = field("Last number; included if a step reaches it.")
    step: DecimalQuantityField | None = optional("Difference between neighbours.")
    count: Annotated[int, Field(ge=1, le=1_000_000, strict=True)] | None = optional(
        "How many numbers, evenly spaced, both ends included."
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield both or neither of step and count, mixed units, and steps away from the last number."""
        if (self.step is None) == (self.count is None):
            yield Inconsistency((), "give either 'step' or 'count'", "count: 11, or step: 0.01")
            return
        numbers = [self.first, self.last, *([self.step] if self.step else [])]
        if common_unit(numbers) is None:
            yield Inconsistency(("last",), "the numbers of a range have different units", _ONE_UNIT)
        elif self.size == 0:
            yield Inconsistency(
                ("step",), f"steps of {self.step} do not lead from {self.first} to {self.last}"
            )
        elif self.size > MOST_POINTS:
            message = f"{self.size} values; at most {MOST_POINTS} are accepted"
            yield Inconsistency(("step",), message, "choose a larger step")

    @property
    def size(self) -> int:
        """How many numbers it has, counted without making them."""
        if self.step is None:
            return self.count or 0
        return count_by_step(self.first.number, self.last.number, self.step.number)


class Normal(Model):
    """A normal distribution, truncated at both ends."""

    mean: DecimalQuantityField = field("Mean before the ends are cut off.")
    deviation: DecimalQuantityField = field("Standard deviation before the ends are cut off.")
    lower: DecimalQuantityField = field("Smallest value.")
    upper: DecimalQuantityField = field("Largest value.")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield mixed units, a deviation that is not above zero, bounds in the wrong order."""
        if common_unit([self.mean, self.deviation, self.lower, self.upper]) is None:
            yield Inconsistency(("mean",), "the numbers of a distribution have different units", _ONE_UNIT)
        elif self.deviation.number <= 0:
            yield Inconsistency(("deviation",), f"{self.deviation} is not above zero")
        elif self.lower.number >= self.upper.number:
            yield Inconsistency(("upper",), f"{self.upper} does not lie above {self.lower}")
        else:
            yield from self._ends_too_far_off()

    def _ends_too_far_off(self) -> Iterator[Inconsistency]:
        farthest = FARTHEST_END * self.deviation.number
        above, below = self.lower.number - self.mean.number, self.mean.number - self.upper.number
        hint = "only this value would be drawn; move it or the mean, or widen the deviation"
        for key, end, side, distance in (
            ("lower", self.lower, "above", above),
            ("upper", self.upper, "below", below),
        ):
            if distance > farthest:
                message = f"{end} lies more than {FARTHEST_END} deviations {side} the mean"
                yield Inconsistency((key,), message, hint)


def _numbers(words: str, *names: str) -> BeforeValidator:
    """Return a check that a list has an entry for each of the names."""

    def check(entry: object) -> object:
        if isinstance(entry, list | tuple) and len(entry) == len(names):
            return entry
        actual = f"{len(entry)}" if isinstance(entry, list | tuple) else "no list"
        message = f"expected {words}, [{', '.join(names)}], found {actual}"
        raise PydanticCustomError("numbers", "{message}", {"message": message})

    return BeforeValidator(check)


TwoBounds = Annotated[
    tuple[DecimalQuantityField, DecimalQuantityField], _numbers("two bounds", "lowest", "highest")
]
ThreeValues = Annotated[
    tuple[DecimalQuantityField, DecimalQuantityField, DecimalQuantityField],
    _numbers("three values", "lowest", "likeliest", "highest"),
]


class Distribution(Model):
    """The distribution of one parameter: exactly one of five."""

    uniform: TwoBounds | None = optional(
        "Smallest and largest value; everything between is equally likely.", examples=[[0.08, 0.16]]
    )
    log_uniform: TwoBounds | None = optional(
        "Smallest and largest value, above zero; the logarithm is uniform.",
        alias="log-uniform",
        examples=[["0.8e-8 m3/(s Pa)", "1.6e-8 m3/(s Pa)"]],
    )
    triangular: ThreeValues | None = optional(
        "Smallest, likeliest and largest value; the density is a triangle.",
        examples=[["80 %", "100 %", "100 %"]],
    )
    normal: Normal | None = optional(
        "Normal, cut off at both ends; what lies beyond them is not drawn.",
        examples=[{"mean": "32 t", "deviation": "0.5 t", "lower": "30 t", "upper": "34 t"}],
    )
    choice: tuple[Any, ...] | None = optional(
        "Values that the key accepts, each as likely as the others.",
        min_length=1,
        max_length=10_000,
        examples=[["one-caliper", "four-caliper"]],
    )

    @model_validator(mode="before")
    @classmethod
    def _named(cls, value: Any) -> Any:
        if isinstance(value, dict | cls):
            return value
        hint = f"accepted: {', '.join(cls._forms())}; such as {{uniform: [0.08, 0.16]}}"
        context = {"message": "expected a distribution by its name", "hint": hint}
        raise PydanticCustomError("distribution", "{message}", context)

    @classmethod
    def _forms(cls) -> list[str]:
        return [field.alias or name for name, field in cls.model_fields.items()]

    @property
    def form(self) -> str:
        """Name of the distribution that is given."""
        return next(name for name, value in self if value is not None)

    @property
    def quantities(self) -> tuple[DecimalQuantity, ...]:
        """The smallest, the likeliest (if any) and the largest value; a choice has none."""
        if self.normal is not None:
            return self.normal.lower, self.normal.upper
        return self.uniform or self.log_uniform or self.triangular or ()

    @property
    def bounds(self) -> tuple[DecimalQuantity, DecimalQuantity]:
        """The smallest and the largest value of a distribution that is not a choice."""
        first, *_, last = self.quantities
        return first, last

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield none or several distributions at once, mixed units, bounds in the wrong order."""
        if sum(value is not None for _, value in self) != 1:
            yield Inconsistency((), "give exactly one distribution", f"accepted: {', '.join(self._forms())}")
            return
        values = self.uniform or self.log_uniform or self.triangular
        if values is None:
            return
        key = "log-uniform" if self.log_uniform else self.form
        numbers = [quantity.number for quantity in values]
        if common_unit(values) is None:
            yield Inconsistency((key,), "the numbers of a distribution have different units", _ONE_UNIT)
        elif numbers != sorted(numbers) or numbers[0] == numbers[-1]:
            yield Inconsistency((key,), f"the values must rise from {values[0]} to {values[-1]}")
        elif self.log_uniform and numbers[0] <= 0:
            yield Inconsistency((key,), f"{values[0]} has no logarithm")


class Sample(Model):
    """Points drawn from the distributions of several parameters."""

    method: Method = field(
        "random; sobol and latin-hypercube fill space more evenly; saltelli for sensitivities.",
        default="random",
    )
    size: int = field(
        "Number of points; saltelli makes (parameters + 2) cases of each.", ge=1, le=MOST_POINTS, strict=True
    )
    seed: int = field("Seed of the draws.", default=0, ge=0, le=2**32 - 1, strict=True)
    parameters: dict[str, Distribution] = field("Distributions by dotted key.", min_length=1, max_length=64)

    @property
    def cases(self) -> int:
        """Number of cases in the sample."""
        return self.size * (len(self.parameters) + 2) if self.method == "saltelli" else self.size

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield sizes for which a Sobol sequence is unbalanced."""
        if self.method in ("sobol", "saltelli") and self.size & (self.size - 1):
            below = 1 << (self.size.bit_length() - 1)
            yield Inconsistency(
                ("size",),
                f"{self.size} points of a Sobol sequence are unbalanced",
                f"take a power of two: {below} or {2 * below}",
            )


Lists = dict[str, Annotated[tuple[Any, ...], Field(min_length=1)]]


class Vary(Model):
    """What a sweep varies: one scenario, run with many values of some of its parameters.

    The cases are all combinations of `matrix`, `ranges`, the rows of `zip` and the points of `sample`.
    """

    matrix: Lists | None = optional(
        "Lists of values by dotted key; every combination is run, first key slowest."
    )
    ranges: dict[str, Range] | None = optional(
        "Ranges of numbers by dotted key, combined like lists of `matrix`."
    )
    zip: Lists | None = optional("Lists of equal length by dotted key; values at the same place go together.")
    sample: Sample | None = optional("Values drawn from distributions.")
