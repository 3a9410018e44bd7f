"""Friction along the track and over time, as points between which it is interpolated."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field

from uictest.plans.scenario.parts.rail import Friction
from uictest.plans.scenario.yaml import Inconsistency, Model, Quantity, of_kind

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
