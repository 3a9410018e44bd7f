"""One parameter of a controller from outside, as its author declares it."""

from collections.abc import Iterator
from typing import Annotated

from pydantic import BeforeValidator, Field

from uictest.controllers import parameter_problems
from uictest.plans.scenario.parts.parameter_value import ParameterValue
from uictest.plans.scenario.yaml import Inconsistency, Section

Bound = Annotated[float, Field(strict=True, allow_inf_nan=False)]


def _unit(value: object) -> object:
    return "1" if value == 1 and not isinstance(value, bool) else value


class DeclaredParameter(Section):
    """What a parameter is measured in, what it is where nobody gives it, and what it may be."""

    default: ParameterValue = Field(description="Handed to the controller where nobody gives the parameter.")
    unit: Annotated[str, BeforeValidator(_unit)] = Field(
        default="", max_length=20, description="Unit of a number, for people; 1 for a pure number."
    )
    range: tuple[Bound, Bound] | None = Field(
        default=None, description="Smallest and largest value that is accepted; any if left out."
    )
    description: str = Field(default="", max_length=500, description="One line for people.")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a number without a unit, a range upside down, and a default outside of it."""
        numbers = self.default if isinstance(self.default, tuple) else (self.default,)
        if not self.unit and all(
            type(each) is not bool and isinstance(each, int | float) for each in numbers
        ):
            yield Inconsistency(
                (), "a number needs a unit", 'write `unit: s`, or `unit: "1"` for a pure number'
            )
        if self.range is not None and self.range[0] > self.range[1]:
            yield Inconsistency(("range",), "the first number of a range is its smallest", "exchange them")
        for problem in parameter_problems({"default": self}, {"default": self.default}):
            yield Inconsistency(("default",), problem.message, problem.hint)
