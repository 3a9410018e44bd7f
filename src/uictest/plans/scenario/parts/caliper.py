"""The caliper: the physical model that stands in for the hardware."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from uictest.plans.scenario.yaml import Inconsistency, Part, Quantity, of_kind


class Caliper(Part):
    """A brake cylinder with its lever and pads."""

    folder: ClassVar[str] = "calipers"

    schema_id: Literal["uictest/caliper/1"] = Field(
        default="uictest/caliper/1", alias="schema", description="What the file holds: uictest/caliper/1."
    )
    piston_area: Annotated[Quantity, of_kind("area", at_least="1 cm2", at_most="0.5 m2")] = Field(
        description="Piston area."
    )
    preload: Annotated[Quantity, of_kind("force", at_least="0 N", at_most="20 kN")] = Field(
        description="Force of the return spring with the piston fully back."
    )
    spring_rate: Annotated[Quantity, of_kind("stiffness", at_least="0 N/m", at_most="1e7 N/m")] = Field(
        description="Rate of the return spring."
    )
    coulomb_friction: Annotated[Quantity, of_kind("force", at_least="0 N", at_most="5 kN")] = Field(
        description="Friction that does not depend on the load, at the piston."
    )
    load_friction: Annotated[Quantity, of_kind("share", at_least="0 %", at_most="50 %")] = Field(
        description="Friction of seals and pins as a share of the load they carry."
    )
    viscous_friction: Annotated[Quantity, of_kind("damping", at_least="0 N s/m", at_most="1e7 N s/m")] = (
        Field(description="Friction that grows with piston speed, at the piston.")
    )
    contact_friction: Annotated[Quantity, of_kind("damping", at_least="0 N s/m", at_most="1e7 N s/m")] = (
        Field(description="Friction of lever, pins and pads that grows with their speed, at the piston.")
    )
    clearance: Annotated[Quantity, of_kind("length", at_least="0 mm", at_most="50 mm")] = Field(
        description="Piston stroke until the pads touch the disc."
    )
    contact_stiffness: Annotated[Quantity, of_kind("stiffness", at_least="1 kN/m", at_most="1e10 N/m")] = (
        Field(description="Stiffness of lever, pads and disc once in contact, at the piston.")
    )
    lever_ratio: Annotated[Quantity, of_kind("number", at_least="0.01", at_most="20")] = Field(
        description="Clamping force over the net force at the piston."
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a piston that nothing holds before the pads touch."""
        yield from super().inconsistencies()
        if self.spring_rate == 0.0 and self.viscous_friction == 0.0:
            yield Inconsistency(
                ("viscous_friction",),
                "a piston without spring rate and viscous friction has no stroke that follows from its load",
                "give spring_rate or viscous_friction",
            )
