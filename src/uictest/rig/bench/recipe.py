"""A bench recipe: the rig it is for and the inputs that are applied one after the other."""

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from uictest.plans.scenario.yaml import Part, Quantity, Section, of_kind

Pressure = Annotated[Quantity, of_kind("pressure", at_least="0 bar", at_most="12 bar")]
Duration = Annotated[Quantity, of_kind("time", above="0 s", at_most="600 s")]
Seed = Annotated[int, Field(ge=0, le=2**32 - 1, strict=True)]
Span = tuple[Duration, Duration]


class Rest(Section):
    """No pressure demanded, the valves fill: the brake is released."""

    kind: Literal["rest"]
    duration: Duration = Field(description="How long.")


class Stepwise(Section):
    """Pressure levels demanded one after the other, WSP bypassed."""

    kind: Literal["stepwise"]
    levels: tuple[Pressure, ...] = Field(min_length=1, max_length=1000, description="Gauge pressures.")
    hold: Duration = Field(description="Time at each level.")


class Triangular(Section):
    """Ramps up to each peak and down again, WSP bypassed."""

    kind: Literal["triangular"]
    peaks: tuple[Pressure, ...] = Field(min_length=1, max_length=1000, description="Gauge pressures.")
    floor: Pressure = Field(description="Gauge pressure between two peaks.")
    ramp: Duration = Field(description="Time for one bar.")


class Random(Section):
    """Straight lines between random pressures, WSP bypassed."""

    kind: Literal["random"]
    lowest: Pressure = Field(description="Least gauge pressure that is drawn.")
    highest: Pressure = Field(description="Largest gauge pressure that is drawn.")
    interval: Duration = Field(description="Time between two drawn pressures.")
    duration: Duration = Field(description="How long.")
    seed: Seed = Field(description="Seed of the draw.")


class WspCycling(Section):
    """A full application, then vent, hold and fill in turn for random times."""

    kind: Literal["wsp"]
    pressure: Pressure = Field(description="Gauge pressure demanded of the brake line.")
    lead: Duration = Field(description="Time of filling before the first vent.")
    cycles: int = Field(ge=1, le=10_000, strict=True, description="Number of vents.")
    vent: Span = Field(description="Shortest and longest vent.")
    hold: Span = Field(description="Shortest and longest hold.")
    fill: Span = Field(description="Shortest and longest fill.")
    seed: Seed = Field(description="Seed of the draw.")


class StopReplay(Section):
    """Demand and valve commands of one wheelset in the recipe's stop, simulated on its rig."""

    kind: Literal["stop"]
    friction: Annotated[Quantity, of_kind("number", at_least="0.001", at_most="1")] = Field(
        description="Initial friction coefficient of the rail."
    )
    position: str | None = Field(default=None, description="Brake position; none: that of the recipe's stop.")
    wheelset: int = Field(ge=1, le=4, strict=True, description="Wheelset whose commands are taken.")
    seed: Seed = Field(description="Seed of the sensors' noise in that stop.")


class FileReplay(Section):
    """Demand, and commands if there are any, from a recording."""

    kind: Literal["trace"]
    file: str = Field(description="Recording; a path relative to the recipe.")
    pressure: str = Field(default="demanded_pressure", description="Channel of the demanded gauge pressure.")
    command: str | None = Field(default=None, description="Channel of the valve command; none: always fill.")


Input = Annotated[
    Rest | Stepwise | Triangular | Random | WspCycling | StopReplay | FileReplay, Field(discriminator="kind")
]


class BenchRecipe(Part):
    """A bench test of the caliper, without vehicle and controller."""

    folder: ClassVar[str] = "benches"

    schema_id: Literal["uictest/bench/1"] = Field(
        alias="schema", description="What the file holds and in which version: uictest/bench/1."
    )
    stop: dict[str, Any] = Field(
        default_factory=dict,
        description="A scenario without schema and name: its rig, brake and seed are used.",
    )
    inputs: tuple[Input, ...] = Field(min_length=1, max_length=1000, description="One after the other.")
