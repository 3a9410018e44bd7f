"""Sanders of a car, and what sand does on the rail.

No publication gives these numbers. Law, share that is kept and largest rate are those of the study `sand`,
which fits the law to two stops of RSSB T1107 and selects the other two numbers; all else is chosen.
"""

from collections.abc import Iterator
from typing import Annotated, Any, Final, Literal

from pydantic import Field

from uictest.core.physics import MOST_SAND_POINTS
from uictest.plans.scenario.yaml import DEFAULT_SOURCE, Inconsistency, Model, Quantity, parse_quantity
from uictest.plans.scenario.yaml.quantity_field import default, field, of_kind, optional, quantity

_SHARE_OF_WHEELBASE: Final = 0.8
"""How far ahead of its wheelset a nozzle may stand: safely behind the wheelset before; chosen."""


class SandPoint(Model):
    """What one density of sand does."""

    density: Quantity = quantity("Sand on one rail.", "line density", "0 g/m .. 1000 g/m")
    share: Quantity = quantity("Share of the way to the friction with enough sand.", "number", "0 .. 1")


def _ranged(text: str, low: str, high: str) -> Quantity:
    """Return a default with its plausible range."""
    ends = (parse_quantity(low, "number", DEFAULT_SOURCE), parse_quantity(high, "number", DEFAULT_SOURCE))
    value = default(text, "number")
    return Quantity(float(value), value.text, value.unit, DEFAULT_SOURCE, ends)


_TABLE: Final = (
    *((0, 0), (1, 0.112), (2, 0.211), (3, 0.299), (4, 0.378), (6, 0.509), (8, 0.613), (12, 0.759)),
    *((16, 0.850), (24, 0.942), (40, 0.991), (60, 1)),
)
"""1 - exp(-d / 8.43 g/m), fitted by the study `sand`: slope 0.0332 m/g from 0.02 to 0.30."""


class Sand(Model):
    """What sand does on the rail, and how much of it a wheelset leaves."""

    friction: Annotated[Quantity, of_kind("number", "0.001 .. 1")] = field(
        "Initial friction coefficient of a rail with enough sand; a better rail keeps its own.",
        default=_ranged("0.30", "0.24", "0.36"),
    )
    kept: Annotated[Quantity, of_kind("number", "0 .. 1")] = field(
        "Share of the sand before a wheelset that it leaves behind.", default=_ranged("0.8", "0.6", "0.95")
    )
    points: tuple[SandPoint, ...] = field(
        "What densities do, in their order, with straight lines between; the ends go on unchanged.",
        default=tuple(
            SandPoint(density=default(f"{density} g/m", "line density"), share=default(f"{share}", "number"))
            for density, share in _TABLE
        ),
        min_length=2,
        max_length=MOST_SAND_POINTS,
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield densities out of order, and an effect without sand."""
        if self.points[0].density > 0.0 or self.points[0].share > 0.0:
            yield Inconsistency(
                ("points", 0), "the table does not begin without sand", "write {density: 0 g/m, share: 0}"
            )
        for place, point in enumerate(self.points[1:], start=1):
            if point.density <= self.points[place - 1].density:
                yield Inconsistency(
                    ("points", place, "density"),
                    f"{point.density.text} does not come after {self.points[place - 1].density.text}",
                    "density must increase from point to point",
                )


class Sander(Model):
    """A sander with its nozzle ahead of a wheelset; its rates are those of one rail."""

    wheelset: Annotated[int, Field(ge=1, le=4, strict=True)] = field(
        "Wheelset ahead of which its nozzle stands, 1 to 4 from the leading end."
    )
    density: Annotated[Quantity, of_kind("line density", "> 0 g/m .. 100 g/m")] | None = optional(
        "Density at which a variable sander aims; a sander without one lays its rate at every speed."
    )
    rate: Annotated[Quantity, of_kind("sand rate", "> 0 kg/min .. 60 kg/min")] | None = optional(
        "Rate, of a variable sander its largest one: 6 kg/min if left out."
    )
    when: Literal["always", "sliding", "requested"] = field(
        "What demands sand: the brake command, the WSP that acts, or a controller of contract version 2.",
        default="sliding",
    )
    distance: Quantity = quantity(
        "Distance of the nozzle ahead of its wheelset.", "length", "0.1 m .. 1.5 m", default="0.3 m"
    )
    delay: Quantity = quantity(
        "Time from the demand to sand on the rail, and from its end to the last of it.",
        "time",
        "0 s .. 10 s",
        default="0.5 s",
    )
    off_below: Quantity = quantity(
        "Train speed below which no sand is demanded.", "speed", "0 km/h .. 100 km/h", default="10 km/h"
    )
    sliding_time: Quantity = quantity(
        "Time for which the WSP must hold or vent wheelsets of the car without a break before they count as"
        " sliding.",
        "time",
        "0 s .. 10 s",
        default="0.2 s",
    )
    run_on: Quantity = quantity(
        "Time without a hold or vent after which they no longer do.", "time", "0 s .. 60 s", default="3 s"
    )

    @property
    def largest_rate(self) -> float:
        """The largest rate, kg/s."""
        return float(_LARGEST_RATE if self.rate is None else self.rate)

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a sander that does not say what it lays."""
        if self.density is None and self.rate is None:
            yield Inconsistency((), "the sander lays nothing", "add `density: 7.5 g/m` or `rate: 2 kg/min`")


_LARGEST_RATE: Final = default("6 kg/min", "sand rate")
"""Of a variable sander that states none; chosen, with a range of 4 to 8 kg/min."""


def impossible_sanders(scenario: Any) -> Iterator[Inconsistency]:
    """Yield sanders that a scenario's car cannot have or that would never lay sand."""
    wheelbase = 2.0 * scenario.vehicle.bogie.half_wheelbase
    for place, sander in enumerate(scenario.sanders):
        key = ("sanders", place)
        if any(sander.wheelset == other.wheelset for other in scenario.sanders[:place]):
            yield Inconsistency((*key, "wheelset"), f"wheelset {sander.wheelset} has two sanders")
        if sander.distance > _SHARE_OF_WHEELBASE * wheelbase:
            yield Inconsistency(
                (*key, "distance"),
                f"{sander.distance.text} ahead the nozzle comes too near to the wheelset before it",
                f"at most {_SHARE_OF_WHEELBASE * wheelbase:.3g} m are accepted with this wheelbase",
            )
        if sander.when == "sliding" and scenario.rig.wsp == "bypassed":
            yield Inconsistency(
                (*key, "when"), "a bypassed WSP never acts", "write `when: always`, or `rig.wsp: active`"
            )
        if sander.when == "requested" and scenario.controller.program is None:
            yield Inconsistency(
                (*key, "when"),
                "no controller that is built in asks for sand",
                "write `when: sliding`, or name a controller from outside of contract version 2",
            )
