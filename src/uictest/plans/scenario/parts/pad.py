"""The brake pad: how its friction depends on speed, force and temperature."""

import math
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Discriminator, Tag

from uictest.core.physics import MOST_PAD_POINTS, quotient_scale
from uictest.plans.scenario.parts.rail import out_of_order
from uictest.plans.scenario.yaml import Inconsistency, Model, Part, Quantity, Section
from uictest.plans.scenario.yaml.quantity_field import field, of_kind, optional, schema_field

Factor = Annotated[Quantity, of_kind("number", "0.1 .. 5")]
FrictionSpeed = Annotated[Quantity, of_kind("speed", "0 km/h .. 1000 km/h")]
PadForce = Annotated[Quantity, of_kind("force", "0 kN .. 500 kN")]
SpeedOffset = Annotated[Quantity, of_kind("speed", "1 km/h .. 1000 km/h")]
ForceOffset = Annotated[Quantity, of_kind("force", "0.1 kN .. 1000 kN")]
DiscTemperature = Annotated[Quantity, of_kind("temperature", "-60 degC .. 1200 degC")]

_POINTS = "Points in order, with straight lines between; the ends go on unchanged."


class PadLaw(Section):
    """A factor on pad friction over one quantity: that of its table times that of its quotient."""

    @property
    def table(self) -> tuple[tuple[float, float], ...]:
        """Values of the quantity, SI, and factors."""
        return ((0.0, 1.0),)

    @property
    def quotient(self) -> tuple[float, float, float]:
        """The value at which (x + a)/(x + b) is scaled to 1, then a and b, SI."""
        return 0.0, 1.0, 1.0

    @property
    def largest_factor(self) -> float:
        """Largest factor anywhere: of the table, and of the quotient, which is monotonic, at either end."""
        reference, numerator, denominator = self.quotient
        scale = quotient_scale(reference, numerator, denominator)
        return max(factor for _, factor in self.table) * scale * max(numerator / denominator, 1.0)


class PadTable(PadLaw):
    """A table of points: one quantity, named by `quantity`, and a factor each."""

    quantity: ClassVar[str]

    points: tuple[Any, ...]

    @property
    def table(self) -> tuple[tuple[float, float], ...]:
        """Values of the quantity, SI, and factors."""
        return tuple((float(getattr(point, self.quantity)), float(point.factor)) for point in self.points)

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield points out of order."""
        yield from out_of_order([getattr(point, self.quantity) for point in self.points], self.quantity)


class PadSpeedPoint(Model):
    """The factor on pad friction at one speed."""

    speed: FrictionSpeed = field("Speed of the disc at the mean radius of the pads.")
    factor: Factor = field("Factor on `pad_friction` there.")


class PadSpeedTable(PadTable):
    """Pad friction over speed: a table."""

    quantity: ClassVar[str] = "speed"

    points: tuple[PadSpeedPoint, ...] = field(_POINTS, min_length=1, max_length=MOST_PAD_POINTS)


class PadForcePoint(Model):
    """The factor on pad friction under one clamping force."""

    force: PadForce = field("Clamping force of one pad.")
    factor: Factor = field("Factor on `pad_friction` there.")


class PadForceTable(PadTable):
    """Pad friction over clamping force: a table."""

    quantity: ClassVar[str] = "force"

    points: tuple[PadForcePoint, ...] = field(_POINTS, min_length=1, max_length=MOST_PAD_POINTS)


class PadTemperaturePoint(Model):
    """The factor on pad friction at one temperature."""

    temperature: DiscTemperature = field("Temperature of the friction surface of the disc.")
    factor: Factor = field("Factor on `pad_friction` there.")


class PadTemperatureTable(PadTable):
    """Pad friction over the temperature of the disc: a table."""

    quantity: ClassVar[str] = "temperature"

    points: tuple[PadTemperaturePoint, ...] = field(_POINTS, min_length=1, max_length=MOST_PAD_POINTS)


class PadQuotient(PadLaw):
    """A quotient of straight lines, (x + numerator)/(x + denominator), scaled to 1 at the reference."""

    numerator: Quantity
    denominator: Quantity
    reference: Quantity

    @property
    def quotient(self) -> tuple[float, float, float]:
        """Reference, numerator and denominator, SI."""
        return float(self.reference), float(self.numerator), float(self.denominator)


class PadSpeedQuotient(PadQuotient):
    """Pad friction over the speed of the disc at the mean radius, as a quotient of straight lines."""

    numerator: SpeedOffset = field("Speed added in the numerator.")
    denominator: SpeedOffset = field("Speed added in the denominator.")
    reference: FrictionSpeed = field("Speed at which the factor is 1.")


class PadForceQuotient(PadQuotient):
    """Pad friction over the clamping force of one pad, as a quotient of straight lines."""

    numerator: ForceOffset = field("Force added in the numerator.")
    denominator: ForceOffset = field("Force added in the denominator.")
    reference: PadForce = field("Force under which the factor is 1.")


def _form(value: object) -> str:
    if isinstance(value, dict):
        lines = value.keys() & {"numerator", "denominator", "reference"}
        return "quotient" if lines and "points" not in value else "table"
    return "quotient" if isinstance(value, PadQuotient) else "table"


SpeedLaw = Annotated[
    Annotated[PadSpeedTable, Tag("table")] | Annotated[PadSpeedQuotient, Tag("quotient")],
    Discriminator(_form),
]
ForceLaw = Annotated[
    Annotated[PadForceTable, Tag("table")] | Annotated[PadForceQuotient, Tag("quotient")],
    Discriminator(_form),
]


class Pad(Part):
    """How the friction of a pad departs from the brake system's `disc.pad_friction`: a product of factors."""

    folder: ClassVar[str] = "pads"

    schema_id: Literal["uictest/pad/1"] = schema_field("uictest/pad/1")
    speed: SpeedLaw | None = optional(
        "Factor over the speed of the disc at the mean radius: points, or numerator, denominator"
        " and reference of (v + numerator)/(v + denominator); 1 if left out."
    )
    force: ForceLaw | None = optional(
        "Factor over the clamping force of one pad: points, or numerator, denominator and"
        " reference of (F + numerator)/(F + denominator); 1 if left out."
    )
    temperature: PadTemperatureTable | None = optional(
        "Factor over the temperature of the friction surface: points; 1 if left out."
    )

    @property
    def varies(self) -> bool:
        """Whether the friction depends on anything."""
        return not (self.speed is None and self.force is None and self.temperature is None)

    @property
    def largest_factor(self) -> float:
        """Upper bound of the product of all factors."""
        laws = (self.speed, self.force, self.temperature)
        return math.prod(law.largest_factor for law in laws if law is not None)
