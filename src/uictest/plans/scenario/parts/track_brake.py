"""The magnetic track brake of a car: its magnets, and when they are drawn to the rail."""

from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import Field

from uictest.plans.scenario.yaml import Inconsistency, Model, Quantity
from uictest.plans.scenario.yaml.quantity_field import default, field, of_kind, optional, quantity

EMERGENCY = "emergency"
"""The brake position in which a track brake acts if nothing else is said."""
_Offset = Annotated[Quantity, of_kind("speed", "0.1 km/h .. 1000 km/h")]


class TrackBrake(Model):
    """A brake of magnets that rub on the rail; they drag the bogies and load no wheel."""

    attraction: Quantity = quantity(
        "Force with which the rail attracts one magnet.", "force", "1 kN .. 500 kN"
    )
    magnets: Annotated[int, Field(ge=2, le=16, strict=True)] = field(
        "Magnets of the car: half of them on each bogie.", default=4
    )
    when: Literal["emergency", "always", "requested"] = field(
        "When it acts while the brake is applied: in the brake position `emergency`, in every position, or"
        " while the controller asks for it.",
        default=EMERGENCY,
    )
    off_below: Annotated[Quantity, of_kind("speed", "> 0 km/h .. 300 km/h")] | None = optional(
        "Train speed at and below which it is off; it acts to standstill if left out."
    )
    delay: Quantity = quantity(
        "Time from the command or the request until the magnets are down and their current rises.",
        "time",
        "0 s .. 20 s",
        default="1 s",
    )
    rise_time: Quantity = quantity(
        "Time in which the attraction rises to all and falls to nothing.",
        "time",
        "1 ms .. 10 s",
        default="0.2 s",
    )
    friction: Quantity = quantity(
        "Friction coefficient of magnets and rail at high speed.", "number", "0.001 .. 1", default="0.095"
    )
    friction_speeds: tuple[_Offset, _Offset] = field(
        "a and b of the friction coefficient at the speed v, `friction` (v + a)/(v + b); alike: constant.",
        default=(default("9.26 km/h", "speed"), default("4.63 km/h", "speed")),
    )
    cleaning: Quantity = quantity(
        "Share of its work that cleans the rail as sliding does, where the rail can be cleaned.",
        "share",
        "0 % .. 100 %",
        default="0 %",
    )

    @property
    def largest_force(self) -> float:
        """Largest force of all magnets at any speed, N."""
        numerator, denominator = self.friction_speeds
        return self.magnets * self.attraction * self.friction * (numerator / denominator)

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield magnets that two bogies cannot share, and friction that rises with speed."""
        if self.magnets % 2 == 1:
            yield Inconsistency(
                ("magnets",),
                f"{self.magnets} magnets do not split over two bogies",
                f"write the magnets of the whole car: {self.magnets - 1} or {self.magnets + 1}",
            )
        numerator, denominator = self.friction_speeds
        if numerator < denominator:
            yield Inconsistency(
                ("friction_speeds", 1),
                f"{denominator.text} is above {numerator.text}: friction would rise with speed",
                "write the larger speed first: [9.26 km/h, 4.63 km/h]",
            )


def never_requested(scenario: Any) -> Iterator[Inconsistency]:
    """Yield a track brake that waits for the request of a controller that makes none."""
    track = scenario.brake.track
    if track is not None and track.when == "requested" and scenario.controller.program is None:
        yield Inconsistency(
            ("brake", "track", "when"),
            "no controller that is built in asks for the track brake",
            "write `when: always`, or name a controller from outside of contract version 2",
        )
