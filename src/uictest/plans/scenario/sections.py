"""The sections of a scenario: brake, rail, rig and simulation."""

from collections.abc import Iterator
from typing import Annotated, Final, Literal

from pydantic import BeforeValidator, Discriminator, Tag
from pydantic_core import PydanticCustomError

from uictest.plans.scenario.parts.brake import BrakeSystem, Caliper, LoadValve
from uictest.plans.scenario.parts.brake_command import Command, CommandStep
from uictest.plans.scenario.parts.compensation import Compensation
from uictest.plans.scenario.parts.coupler import Transmission
from uictest.plans.scenario.parts.dynamic_brake import DynamicBrake
from uictest.plans.scenario.parts.pad import DiscTemperature, Pad
from uictest.plans.scenario.parts.rail import (
    Cleaning,
    FactorProfile,
    Friction,
    FrictionProfile,
    RailCondition,
    Variation,
    out_of_order,
)
from uictest.plans.scenario.parts.sand import Sand
from uictest.plans.scenario.parts.sensors import Sensors
from uictest.plans.scenario.parts.track_brake import EMERGENCY, TrackBrake
from uictest.plans.scenario.parts.vehicle import Vehicle
from uictest.plans.scenario.yaml import Inconsistency, Key, Model, PartReference, Quantity, quoted, suggestion
from uictest.plans.scenario.yaml.quantity_field import default, field, of_kind, optional, quantity


def _friction_form(value: object) -> str:
    points = isinstance(value, tuple) and any(isinstance(point, dict) for point in value)
    marked = isinstance(value, dict) and "value" in value
    is_profile = isinstance(value, dict | FrictionProfile) and not marked
    return "profile" if points or is_profile else "number"


FrictionAlongTrack = Annotated[
    Annotated[Friction, Tag("number")] | Annotated[FrictionProfile, Tag("profile")],
    Discriminator(_friction_form),
]


def load_share(valve: LoadValve | None, vehicle: Vehicle) -> float:
    """Return the pressure that the load of a vehicle leaves, over that of the full one."""
    if valve is None or vehicle.payload is None:
        return 1.0
    return valve.empty_share + (1.0 - valve.empty_share) * (vehicle.carried_mass / vehicle.payload)


class Brake(Model):
    """The brake of the car and the command it gets."""

    system: Annotated[BrakeSystem, PartReference(BrakeSystem, "ep-disc")] = field(
        "The brake system: a library name, a relative path or an inline mapping."
    )
    command: Command = field(
        "Share of the full service command; or a list of commands, each from a time on.",
        default=default("100 %", "share"),
    )
    position: str = field("Brake position; one of the positions of the brake system.", default="R")
    pad: Annotated[Pad, PartReference(Pad, "constant")] = field(
        "How pad friction varies: a library name, a relative path or an inline mapping."
    )
    dynamic: DynamicBrake | None = optional(
        "The dynamic brake, blended with the friction brake; none if left out."
    )
    track: TrackBrake | None = optional("The magnetic track brake of the car; none if left out.")
    transmission: Transmission | None = optional(
        "How the command comes to the cars of a train: along a wire, or as in {pipe: 250 m/s}; a wire if left"
        " out."
    )
    disc_temperature: Literal["constant", "modelled"] | None = optional(
        "Whether the discs warm up; if left out, they do where the pad's friction depends on it."
    )
    initial_disc_temperature: DiscTemperature | None = optional(
        "Temperature of the discs at the brake command; that of the air if left out."
    )

    @property
    def first_command(self) -> Quantity:
        """Share of the full service command at the beginning."""
        return self.command[0].value if isinstance(self.command, tuple) else self.command

    @property
    def commands(self) -> tuple[tuple[float, float, str], ...]:
        """All commands: time since the first, s, share of full service, position."""
        if not isinstance(self.command, tuple):
            return ((0.0, self.command, self.position),)
        return tuple((each.at, each.value, each.position or self.position) for each in self.command)

    @property
    def command_text(self) -> str:
        """All commands as written, `60 %, 100 % from 4 s (emergency)`."""
        if not isinstance(self.command, tuple):
            return self.command.text
        rest = (
            f"{each.value.text} from {each.at.text}{f' ({each.position})' if each.position else ''}"
            for each in self.command[1:]
        )
        return ", ".join([self.command[0].value.text, *rest])

    @property
    def commanded_pressure(self) -> float:
        """Pressure of the brake line of a full car once the first application is developed, gauge, Pa."""
        _, share, position = self.commands[0]
        return share * self.system.positions[position].maximum_pressure

    @property
    def highest_commanded_pressure(self) -> float:
        """The highest pressure that any command asks for of a full car, gauge, Pa."""
        positions = self.system.positions
        return max(share * positions[position].maximum_pressure for _, share, position in self.commands)

    @property
    def highest_full_pressure(self) -> float:
        """The highest pressure of a full service command in any position that is used, gauge, Pa."""
        return max(self.system.positions[position].maximum_pressure for _, _, position in self.commands)

    @property
    def models_disc_temperature(self) -> bool:
        """Whether the temperature of the discs is modelled."""
        if self.disc_temperature is None:
            return self.pad.temperature is not None
        return self.disc_temperature == "modelled"

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield positions that the system does not have, and commands out of order."""
        if self.position not in self.system.positions:
            yield self._unknown_position(("position",), self.position)
        if isinstance(self.command, tuple):
            yield from self._course_problems(self.command)
        if self.track is not None and self.track.when == EMERGENCY not in self.system.positions:
            yield Inconsistency(
                ("track",),
                f"this brake has no position {quoted(EMERGENCY)}, in which alone the track brake acts",
                "write when: always, or when: requested",
            )
        if self.models_disc_temperature and self.system.disc.thermal is None:
            yield Inconsistency(
                ("pad",) if self.disc_temperature is None else ("disc_temperature",),
                "brake.system.disc.thermal is missing: what the discs warm up by is not known",
                "add system.disc.thermal, or write disc_temperature: constant",
            )

    def _course_problems(self, steps: tuple[CommandStep, ...]) -> Iterator[Inconsistency]:
        first = steps[0]
        if first.at > 0.0 or first.value == 0.0:
            what = "at" if first.at > 0.0 else "value"
            yield Inconsistency(
                ("command", 0, what),
                "times count from the first command, which applies the brake",
                "begin with {at: 0 s, value: 60 %} or another share",
            )
        for problem in out_of_order([each.at for each in steps], "at"):
            yield problem._replace(key=("command", *problem.key[1:]))
        for place, step in enumerate(steps):
            if step.position is not None and step.position not in self.system.positions:
                yield self._unknown_position(("command", place, "position"), step.position)

    def _unknown_position(self, key: Key, name: str) -> Inconsistency:
        hint = suggestion(name, self.system.positions)
        return Inconsistency(key, f"unknown brake position {quoted(name)}", hint)


class Rail(Model):
    """The rail under the car."""

    condition: Annotated[RailCondition, PartReference(RailCondition, "dry")] = field(
        "Rail condition: dry, wet, a relative path or an inline mapping."
    )
    friction: FrictionAlongTrack | None = optional(
        "Initial friction coefficient, or points along the track; the condition's if left out."
    )
    friction_over_time: FactorProfile | None = optional(
        "Factor on the friction coefficient over time; 1 throughout if left out."
    )
    cleaning: Cleaning | None = optional("How sliding cleans the rail; as the condition says if left out.")
    variation: Variation | None = optional(
        "How friction varies at random along the track; as the condition says if left out."
    )
    sand: Sand = field("What sand does on the rail; nothing without sanders.", default=Sand())
    gradient: Quantity = quantity(
        "Gradient of the track, positive uphill.",
        "gradient",
        "-60 permille .. 60 permille",
        default="0 permille",
    )

    @property
    def highest_friction(self) -> float:
        """The highest friction coefficient anywhere, at any time."""
        factor = (
            1.0
            if self.friction_over_time is None
            else max(at.factor for at in self.friction_over_time.points)
        )
        if isinstance(self.friction, FrictionProfile):
            return factor * max(at.friction for at in self.friction.points)
        return factor * (self.condition.friction if self.friction is None else self.friction)

    @property
    def friction_as_found(self) -> str:
        """The friction coefficient before anything slides: `0.09`, `0.05 .. 0.15 along the track`."""
        if isinstance(self.friction, FrictionProfile):
            along = [at.friction for at in self.friction.points]
            text = f"{min(along):.3g} .. {max(along):.3g} along the track"
        else:
            text = f"{self.condition.friction if self.friction is None else self.friction:.3g}"
        return text if self.variation_in_force is None else f"{text}, varying at random"

    @property
    def cleaning_in_force(self) -> Cleaning | None:
        """How sliding cleans the rail, or None where it does not."""
        return self.condition.cleaning if self.cleaning is None else self.cleaning

    @property
    def variation_in_force(self) -> Variation | None:
        """How friction varies at random, or None where it does not."""
        variation = self.condition.variation if self.variation is None else self.variation
        return None if variation is None or variation.spread == 0.0 else variation

    @property
    def highest_friction_after_cleaning(self) -> float:
        """The highest friction coefficient that a wheelset can meet."""
        cleaning, variation = self.cleaning_in_force, self.variation_in_force
        found = self.highest_friction * (1.0 if variation is None else variation.highest_factor)
        return found if cleaning is None else max(found, cleaning.recovered_friction)


class Rig(Model):
    """How the rig is built up."""

    topology: Literal["one-caliper", "four-caliper"] = field(
        "One caliper and three tanks, or a caliper in every module.", default="one-caliper"
    )
    compensation: Literal["none", "hysteresis", "cylinder", "full", "thermal"] = field(
        "What the modules without a caliper compute: hysteresis with the air of the caliper's"
        " module (thermal); or, as in the paper, hysteresis, cylinder dynamics, both (full) or none.",
        default="thermal",
    )
    wsp: Literal["active", "bypassed"] = field(
        "Whether the WSP valves obey the controller or always fill.", default="active"
    )
    caliper: Annotated[Caliper, PartReference(Caliper, "six-inch")] = field(
        "The caliper: a library name, a relative path or an inline mapping."
    )
    compensation_model: Annotated[Compensation, PartReference(Compensation, "six-inch")] = field(
        "The compensation: a library name, a relative path or an inline mapping."
    )
    sensors: Annotated[Sensors, PartReference(Sensors, "standard")] = field(
        "The sensors: a library name, a relative path or an inline mapping."
    )


class Drag(Model):
    """Drag braking: traction holds a speed while the brake acts."""

    speed: Quantity = quantity(
        "Speed that is held from when the train comes down to it.", "speed", "1 km/h .. 600 km/h"
    )
    duration: Quantity = quantity("Time for which it is held.", "time", "0.1 s .. 3600 s")


SURVEY: Final = "survey"
"""The time step of a whole sweep whose results are to come fast, with a known bias."""


def _no_survey(value: object) -> object:
    if value == SURVEY:
        hint = f"uictest sweep ... --set simulation.time_step={SURVEY}, or alone under `vary.matrix`"
        context = {"message": f"{quoted(SURVEY)} is the time step of a whole sweep", "hint": hint}
        raise PydanticCustomError("survey", "{message}", context)
    return value


class Simulation(Model):
    """How the stop is simulated."""

    time_step: Annotated[Quantity, of_kind("time", "0.01 ms .. 1 ms"), BeforeValidator(_no_survey)] = field(
        "Base step; a whole number of them makes a controller cycle.", default=default("0.5 ms", "time")
    )
    maximum_duration: Quantity = quantity(
        "Simulated time after which a stop is aborted; what is undecided then is inconclusive.",
        "time",
        "> 0 s .. 3600 s",
        default="180 s",
    )
