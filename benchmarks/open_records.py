"""The rig's records as plain objects, whose attributes may be floats, arrays or traced values."""

from collections.abc import Callable, Iterator, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
from stops import Stop

from uictest.core.physics import arithmetic
from uictest.core.translation import translate
from uictest.rig.model.controller import decide
from uictest.rig.model.cycle import command_valves, read_sensors, start_cycle
from uictest.rig.model.records import needs_of
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.step import step_brake, step_vehicle
from uictest.rig.model.stop import start


class Rig:
    """Car, two bogies and four wheelsets."""

    def __init__(
        self, car: SimpleNamespace, bogies: list[SimpleNamespace], wheelsets: list[SimpleNamespace]
    ) -> None:
        self.car, self.bogies, self.wheelsets = car, bogies, wheelsets

    def numbers(self) -> Iterator[Any]:
        """Yield every field of every record, in one fixed order."""
        for record in (self.car, *self.bogies, *self.wheelsets):
            yield from vars(record).values()

    def filled(self, numbers: Sequence[Any]) -> "Rig":
        """Return a rig of the same fields holding other numbers."""
        remaining = iter(numbers)
        records = [
            SimpleNamespace(**{name: next(remaining) for name in vars(record)})
            for record in (self.car, *self.bogies, *self.wheelsets)
        ]
        return Rig(records[0], records[1:3], records[3:])


def opened(record: Any) -> SimpleNamespace:
    """Return the fields of a record as attributes holding Python numbers."""
    return SimpleNamespace(**{name: record[name].tolist() for name in record.dtype.names})


def rolling(stop: Stop) -> Rig:
    """Return the rig at the brake command, its valves filling."""
    parameters, wheelset_parameters, rail = stop.parameters, stop.wheelset_parameters, stop.rail
    car: Any = np.zeros(1, CAR)
    bogies: Any = np.zeros(2, BOGIE)
    wheelsets: Any = np.zeros(4, WHEELSET)
    start(car[0], bogies, wheelsets, parameters, wheelset_parameters)
    read_sensors(car[0], wheelsets, parameters, needs_of(parameters))
    start_cycle(car[0], wheelsets, parameters, rail)
    decide(car[0], wheelsets, parameters)
    command_valves(car[0], wheelsets, parameters)
    return Rig(
        opened(car[0]), [opened(bogie) for bogie in bogies], [opened(wheelset) for wheelset in wheelsets]
    )


def _step(car: Any, bogies: Any, wheelsets: Any, p: Any) -> None:
    step_brake(car, wheelsets, p)
    step_vehicle(car, bogies, wheelsets, p)


def rounded_twice(a: Any, b: Any, c: Any) -> Any:
    """Return a b + c in two operations: what numpy, JAX and the interpreter have."""
    return a * b + c


def step_on_floats() -> Callable[..., None]:
    """Return the rig's step as the interpreter reads it, but for products and sums that are rounded twice."""
    return step_in(arithmetic.select, arithmetic.minimum, arithmetic.maximum, arithmetic.sqrt)


def step_in(select: Any, minimum: Any, maximum: Any, sqrt: Any) -> Callable[..., None]:
    """Return the rig's step with the operations of another number system."""
    operations: dict[Callable[..., Any], Any] = {
        arithmetic.fma: rounded_twice,
        arithmetic.select: select,
        arithmetic.minimum: minimum,
        arithmetic.maximum: maximum,
        arithmetic.sqrt: sqrt,
    }
    translated: Callable[..., None] = translate(_step, lambda function: function, operations)
    return translated
