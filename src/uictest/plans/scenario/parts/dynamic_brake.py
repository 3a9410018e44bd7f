"""The dynamic brake of a car: what its motors can give."""

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from uictest.plans.scenario.yaml import Inconsistency, Model, Quantity
from uictest.plans.scenario.yaml.quantity_field import default, field, of_kind, quantity

_Speed = Annotated[Quantity, of_kind("speed", "0 km/h .. 100 km/h")]
_Number = Annotated[int, Field(ge=1, le=4, strict=True)]


class DynamicBrake(Model):
    """A brake of motors that work as generators, blended with the friction brake."""

    force: Quantity = quantity(
        "Largest force of the car at the rims, shared alike by its motored wheelsets.",
        "force",
        "0.1 kN .. 1000 kN",
    )
    power: Quantity = quantity("Largest power of the car.", "power", "1 kW .. 20 MW")
    wheelsets: tuple[_Number, ...] = field(
        "The motored wheelsets, by their number from the leading end.", default=(1, 2, 3, 4), min_length=1
    )
    fade_out: tuple[_Speed, _Speed] = field(
        "Speed below which it fades out, and at which it gives nothing any more.",
        default=(default("10 km/h", "speed"), default("5 km/h", "speed")),
    )
    response_time: Quantity = quantity(
        "Time constant with which a motor follows what is asked of it.",
        "time",
        "10 ms .. 10 s",
        default="0.3 s",
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield speeds in the wrong order and wheelsets named twice."""
        begin, end = self.fade_out
        if begin <= end:
            yield Inconsistency(
                ("fade_out", 1),
                f"{end.text} is not below {begin.text}",
                "write the speed below which it fades out, then where it is gone: [10 km/h, 5 km/h]",
            )
        for place, number in enumerate(self.wheelsets):
            if number in self.wheelsets[:place]:
                yield Inconsistency(("wheelsets", place), f"wheelset {number} is named twice")
