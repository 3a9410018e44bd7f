"""The stops that a criterion applies to."""

from typing import Annotated, Literal

from pydantic import Field

from uictest.plans.scenario.yaml import Model, Quantity, of_kind


class NominalSpeed(Model):
    """An initial speed with the tolerance within which a stop is judged, uncorrected."""

    value: Annotated[Quantity, of_kind("speed", above="0 km/h", at_most="600 km/h")] = Field(
        description="Nominal initial speed."
    )
    tolerance: Annotated[Quantity, of_kind("speed", at_least="0 km/h", at_most="600 km/h")] = Field(
        description="Largest deviation either way."
    )


class NominalShare(Model):
    """A brake command with its tolerance."""

    value: Annotated[Quantity, of_kind("share", above="0 %", at_most="100 %")] = Field(
        description="Nominal command."
    )
    tolerance: Annotated[Quantity, of_kind("share", at_least="0 %", at_most="100 %")] = Field(
        description="Largest deviation either way."
    )


class NominalGradient(Model):
    """A gradient with its tolerance."""

    value: Annotated[Quantity, of_kind("gradient", at_least="-60 permille", at_most="60 permille")] = Field(
        description="Nominal gradient, positive uphill."
    )
    tolerance: Annotated[Quantity, of_kind("gradient", at_least="0 permille", at_most="120 permille")] = (
        Field(description="Largest deviation either way.")
    )


Nominal = NominalSpeed | NominalShare | NominalGradient


class Applicability(Model):
    """Conditions of a stop under which a criterion applies; a condition that is not named is not checked."""

    rail_condition: tuple[str, ...] | None = Field(
        default=None, description="Names of rail conditions, e.g. wet."
    )
    rail_condition_other_than: tuple[str, ...] | None = Field(
        default=None, description="Names of rail conditions that the criterion is not for, e.g. dry."
    )
    rail_cleaned: bool | None = Field(
        default=None,
        strict=True,
        description="Whether sliding cleans the rail; a recorded rail answers as it does and meets either.",
    )
    wsp: tuple[Literal["active", "bypassed"], ...] | None = Field(
        default=None, description="States of the WSP."
    )
    brake_position: tuple[str, ...] | None = Field(default=None, description="Brake positions, e.g. R.")
    topology: tuple[Literal["one-caliper", "four-caliper"], ...] | None = Field(
        default=None, description="Topologies of the rig."
    )
    initial_speed: NominalSpeed | None = Field(default=None, description="Initial speed, uncorrected.")
    command: NominalShare | None = Field(default=None, description="Share of the full service command.")
    gradient: NominalGradient | None = Field(default=None, description="Gradient of the track.")
