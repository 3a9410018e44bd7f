"""What a plan holds besides its values: the nominal case, the controllers from outside."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from uictest.plans.scenario import Scenario, wheelset_value
from uictest.plans.scenario.yaml import Quantity, parse_quantity
from uictest.plans.sweeps.base_case import value_at
from uictest.plans.sweeps.plan import Plan, saltelli_sample, values_of

if TYPE_CHECKING:
    from uictest.controllers import ControllerProgram


_OF_WHEELSETS: Final = "vehicle.wheelsets."


class DrawnRange(NamedTuple):
    """The bounds of a distribution, as written, and the value of the scenario itself."""

    key: str
    low: Quantity
    high: Quantity
    nominal: Quantity

    @property
    def contains_nominal(self) -> bool:
        """Whether the scenario's own value can be drawn."""
        return self.low <= self.nominal <= self.high

    def __str__(self) -> str:
        """Return one sentence."""
        lies = "lies inside" if self.contains_nominal else "lies OUTSIDE"
        return (
            f"{self.key}: the scenario's own {self.nominal.text} {lies} the range"
            f" {_shown(self.low)} .. {_shown(self.high)}"
        )


def drawn_ranges(plan: Plan) -> Iterator[DrawnRange]:
    """Yield the ranges of a sample for sensitivities; a choice from a list has none."""
    sample = saltelli_sample(plan)
    for key, draw in zip(sample.keys, sample.draws, strict=True) if sample else ():
        nominal = _nominal_value(plan.base.scenario, key)
        if not draw.choices and isinstance(nominal, Quantity):
            low, high = (parse_quantity(str(bound), draw.kind) for bound in draw.distribution.bounds)
            yield DrawnRange(key, low, high, nominal)


def _nominal_value(scenario: Scenario, key: str) -> Any:
    """Return a value of the scenario; where a wheelset has none of its own, the regular one."""
    value = value_at(scenario, key)
    if value is None and key.startswith(_OF_WHEELSETS):
        number, _, name = key.removeprefix(_OF_WHEELSETS).partition(".")
        return wheelset_value(scenario, int(number), name)
    return value


def _shown(quantity: Quantity) -> str:
    number, _, unit = quantity.text.partition(" ")
    return f"{float(number):g} {unit}".rstrip()


CONTROLLER: Final = "controller"
"""Key of a scenario whose value is a controller."""


def controllers_of(plan: Plan) -> Iterator[tuple[str, Any]]:
    """Yield for each car the key that varies its controller, empty for none, and that of its scenario."""
    train = plan.base.train
    scenarios = (plan.base.scenario,) if train is None else train.scenarios
    own_keys = plan.own_keys or [{key: key for key in plan.keys}] * len(scenarios)
    for scenario, own in zip(scenarios, own_keys, strict=True):
        keys = [key for key in plan.keys if own.get(key) == CONTROLLER]
        yield keys[-1] if keys else "", scenario.controller


def each_controller(plan: Plan) -> Iterator[Any]:
    """Yield the controllers of all cars of all cases, some of them several times."""
    for key, own in controllers_of(plan):
        yield from (value.content for value in values_of(plan, key)) if key else (own,)


def programs_of(plan: Plan) -> Iterator[ControllerProgram]:
    """Yield the program of each controller from outside, with the parameters that are written beside it."""
    for controller in each_controller(plan):
        if controller.program is not None:
            yield controller.program
