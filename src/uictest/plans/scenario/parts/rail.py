"""The rail: the adhesion law (Polach 2005), friction along the track and over time."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from uictest.plans.scenario.yaml import Inconsistency, Model, Part, Quantity, Section, of_kind

Friction = Annotated[Quantity, of_kind("number", at_least="0.001", at_most="1")]
Share = Annotated[Quantity, of_kind("number", at_least="0.001", at_most="1")]
SemiAxis = Annotated[Quantity, of_kind("length", at_least="0.1 mm", at_most="50 mm")]


class Contact(Section):
    """The contact ellipse of one wheel at its reference load; it grows with load (Hertz)."""

    semi_axis_longitudinal: SemiAxis = Field(description="Semi-axis a along the track.")
    semi_axis_lateral: SemiAxis = Field(description="Semi-axis b across the track.")
    shear_modulus: Annotated[Quantity, of_kind("pressure", at_least="1e9 Pa", at_most="1e12 Pa")] = Field(
        description="Shear modulus G of wheel and rail."
    )
    kalker_coefficient: Annotated[Quantity, of_kind("number", at_least="0.1", at_most="20")] = Field(
        description="Kalker's longitudinal creepage coefficient c11."
    )
    reference_wheel_load: Annotated[Quantity, of_kind("force", at_least="0.1 kN", at_most="500 kN")] = Field(
        description="Wheel load at which the semi-axes hold."
    )

    @property
    def creep_stiffness(self) -> float:
        """Tangential stiffness (1/4) G pi a b c11 of the contact at the reference load, N."""
        area = math.pi * self.semi_axis_longitudinal * self.semi_axis_lateral
        return 0.25 * self.shear_modulus * area * self.kalker_coefficient


class Cleaning(Section):
    """How sliding cleans the rail, for itself and for the wheelsets that follow."""

    energy: Annotated[Quantity, of_kind("energy per length", at_least="1 J/m", at_most="1e9 J/m")] = Field(
        description="Wc: contact loss of a wheelset per metre of track that cleans 63 % of the rail."
    )
    recovered_friction: Friction = Field(
        description="Initial friction coefficient of a clean rail; where the rail is better, nothing changes."
    )
    reach: Annotated[Quantity, of_kind("length", at_least="1 mm", at_most="100 m")] = Field(
        description="Length of track over which the cleaned share follows the contact loss."
    )
    carry_over: Annotated[Quantity, of_kind("number", at_least="0", at_most="1")] = Field(
        description="Part of what a wheelset has cleaned that the next one finds at the same place."
    )


class RailCondition(Part):
    """A condition of the rail surface."""

    folder: ClassVar[str] = "rails"

    schema_id: Literal["uictest/rail/1"] = Field(
        default="uictest/rail/1", alias="schema", description="What the file holds: uictest/rail/1."
    )
    friction: Friction = Field(description="Initial friction coefficient mu0, at zero slip speed.")
    friction_ratio: Share = Field(description="A: friction at infinite slip speed over mu0.")
    friction_decay: Annotated[Quantity, of_kind("inverse speed", at_least="0 s/m", at_most="100 s/m")] = (
        Field(description="B: how fast friction falls with slip speed.")
    )
    reduction_adhesion: Share = Field(description="kA: reduction of the creep slope in the area of adhesion.")
    reduction_slip: Share = Field(description="kS: reduction of the creep slope in the area of slip.")
    contact: Contact = Field(description="The contact of one wheel.")
    cleaning: Cleaning | None = Field(
        default=None, description="How sliding cleans the rail; it does not if left out."
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield reduction factors in the wrong order."""
        yield from super().inconsistencies()
        if self.reduction_slip > self.reduction_adhesion:
            yield Inconsistency(
                ("reduction_slip",),
                f"kS = {self.reduction_slip.text} exceeds kA = {self.reduction_adhesion.text}",
                "the law needs reduction_slip <= reduction_adhesion <= 1",
            )


MOST_POINTS = 64


class FrictionPoint(Model):
    """The friction coefficient at one place of the track."""

    position: Annotated[Quantity, of_kind("length", at_least="-100 km", at_most="100 km")] = Field(
        description="Distance from where the brake command is given to the first wheelset, along the track."
    )
    friction: Friction = Field(description="Initial friction coefficient mu0 there.")


class FrictionProfile(Model):
    """The friction coefficient along the track."""

    points: tuple[FrictionPoint, ...] = Field(
        min_length=1,
        max_length=MOST_POINTS,
        description="Points in order of position; the ends go on unchanged.",
    )
    interpolation: Literal["linear", "steps"] = Field(
        default="linear", description="Straight lines between points, or each value up to the next point."
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield points out of order."""
        yield from out_of_order([point.position for point in self.points], "position")


class FactorPoint(Model):
    """The factor on friction at one time."""

    time: Annotated[Quantity, of_kind("time", at_least="0 s", at_most="3600 s")] = Field(
        description="Time since the brake command."
    )
    factor: Annotated[Quantity, of_kind("number", at_least="0.001", at_most="10")] = Field(
        description="Factor on friction then."
    )


class FactorProfile(Model):
    """A factor on the friction coefficient over time."""

    points: tuple[FactorPoint, ...] = Field(
        min_length=1,
        max_length=MOST_POINTS,
        description="Points in order of time, with straight lines between; the ends go on unchanged.",
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield points out of order."""
        yield from out_of_order([point.time for point in self.points], "time")


def out_of_order(values: Sequence[Quantity], name: str) -> Iterator[Inconsistency]:
    """Yield the points of a profile whose ``name`` does not exceed that of the point before."""
    for index, (before, after) in enumerate(pairwise(values), start=1):
        if after <= before:
            yield Inconsistency(
                ("points", index, name),
                f"{after.text} does not come after {before.text}",
                f"{name} must increase from point to point",
            )
