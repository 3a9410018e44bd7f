"""The scenario: what a user writes, defaults filled in, units canonical."""

import math
from collections.abc import Iterator
from typing import Annotated, Any, Final, Literal

from pydantic import BeforeValidator

from uictest.controllers import DEFAULT as DEFAULT_CONTROLLER
from uictest.core.physics import LONGEST_DELAY_CYCLES
from uictest.core.units import STANDARD_GRAVITY
from uictest.plans.faults import MOST_FAULTS
from uictest.plans.scenario.feasibility import (
    endless_stop,
    impossible_courses,
    impossible_pole_wheels,
    impossible_sanders,
    largest_braking_force,
    largest_clamping_force,
    limit_of_air,
    limit_of_vehicle,
    line_leak,
    tank_leak,
)
from uictest.plans.scenario.parts.brake import Brake, never_requested
from uictest.plans.scenario.parts.compensation import (
    COMPENSATION_SETTINGS,
    Compensation,
    unresolved_air,
    unresolved_cylinder,
)
from uictest.plans.scenario.parts.controller import Controller
from uictest.plans.scenario.parts.criteria import RIG_CHECKS, Criteria, criteria_of_the_same_name, rig_checks
from uictest.plans.scenario.parts.equipment import Caliper, Sensors
from uictest.plans.scenario.parts.fault import Fault, impossible_faults
from uictest.plans.scenario.parts.measures import MeasureDefinitions
from uictest.plans.scenario.parts.named_file import (
    PASS,
    Expect,
    OutcomeOfRepeats,
    Repeat,
    TestFile,
    seeds_too_large,
)
from uictest.plans.scenario.parts.rail import Rail, Sander
from uictest.plans.scenario.parts.vehicle import (
    WHEELSET_NUMBERS,
    Coupler,
    Vehicle,
    distinct_values,
    load_share,
    wheelset_value,
)
from uictest.plans.scenario.yaml import (
    DEFAULT_SOURCE,
    Inconsistency,
    Model,
    PartReference,
    Quantity,
    default,
    field,
    of_kind,
    optional,
    quantities_in,
    quantity,
    quoted,
    refused,
    unknown_sources,
)


class RecordTolerances(Model):
    """Beyond which a record contradicts its scenario. Every default is chosen."""

    initial_speed: Quantity = quantity(
        "Difference between the initial speeds.", "speed", "0 km/h .. 100 km/h", default="3 km/h"
    )
    deceleration: Quantity = quantity(
        "Mean deceleration over what the brake can give.", "number", "1 .. 100", default="1.2"
    )
    vacuum: Quantity = quantity(
        "Pressure below that of the surroundings.", "pressure", "0 bar .. 100 bar", default="1.013 bar"
    )
    pressure_fall: Quantity = quantity(
        "Fall of a pressure while the brake is applied.", "pressure", "0 bar .. 100 bar", default="0.1 bar"
    )
    demanded_pressure: Quantity = quantity(
        "Difference of the demanded pressure from the command.", "share", "0 % .. 1000 %", default="15 %"
    )
    duration: Quantity = quantity(
        "Time to lose 10 or 90 % of the speed over what the brake needs.", "number", "1 .. 1000", default="10"
    )


class Record(Model):
    """Settings of the checks of a recorded stop."""

    tolerances: RecordTolerances = field("Tolerances of the checks.", default=RecordTolerances())


def check_id(name: str) -> str:
    """Return the id of the verdict of the check that has this tolerance."""
    return f"record-{name.replace('_', '-')}"


class Rig(Model):
    """Configuration of the rig."""

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
        raise refused(f"{quoted(SURVEY)} is the time step of a whole sweep", hint)
    return value


class Simulation(Model):
    """Settings of the simulation."""

    time_step: Annotated[Quantity, of_kind("time", "0.01 ms .. 1 ms"), BeforeValidator(_no_survey)] = field(
        "Base step; a whole number of them makes a controller cycle.", default=default("0.5 ms", "time")
    )
    maximum_duration: Quantity = quantity(
        "Simulated time after which a stop is aborted; what is undecided then is inconclusive.",
        "time",
        "> 0 s .. 3600 s",
        default="180 s",
    )


class Scenario(TestFile):
    """One stop of the car on the rig, and what is expected of it."""

    schema_id: Literal["uictest/scenario/1"] = field(
        "What the file holds: uictest/scenario/1.", alias="schema"
    )
    extends: str | None = optional(
        "The parent: a relative path, or a scenario that ships; maps merge, lists replace."
    )
    validated: str | None = optional(
        "Relative path of the validation.json of a validation: cases outside of it are flagged."
    )
    vehicle: Annotated[Vehicle, PartReference(Vehicle, "intercity-180")] = field(
        "The vehicle: a library name, a relative path or an inline mapping."
    )
    train: tuple[dict[str, Any], ...] | None = optional(
        "The cars of a train from the leading one on, in place of `vehicle`: what each has of its own."
    )
    coupler: Coupler | None = optional("The couplers of a train.")
    initial_speed: Quantity = quantity(
        "Train speed at which the brake command is given.", "speed", "> 1 km/h .. 600 km/h"
    )
    brake: Brake = field("Brake system, command and position.")
    until: Annotated[Quantity, of_kind("speed", "> 0 km/h .. 600 km/h")] | None = optional(
        "Train speed at which the stop ends; standstill if left out."
    )
    drag: Drag | None = optional("Drag braking: a speed that traction holds for a time; none if left out.")
    rail: Rail = field("Rail condition, friction and gradient.")
    rig: Rig = field("Topology of the rig, compensation, WSP.")
    sanders: tuple[Sander, ...] = field("The sanders of the car.", default=(), max_length=4)
    controller: Annotated[Controller, PartReference(Controller, DEFAULT_CONTROLLER)] = field(
        "The WSP controller under test: a library name, a relative path or an inline mapping."
    )
    faults: tuple[Fault, ...] = field(
        "Faults during the stop; where two act on one number, the later in the list acts last.",
        default=(),
        max_length=MOST_FAULTS,
    )
    criteria: Annotated[tuple[Criteria, ...], PartReference(Criteria, "uictest-stop", several=True)] = field(
        "One profile of criteria or a list of them."
    )
    measures: Annotated[MeasureDefinitions, PartReference(MeasureDefinitions, "standard")] = field(
        "Definitions of the measures: a library name, a relative path or an inline mapping."
    )
    expect: Expect = field(
        "The expected outcome, or what may be missed by name: {fail: [locked-wheels]};"
        " skipped: no criterion is to judge the stop.",
        default=PASS,
    )
    test_validity: Literal["measured", "rail", "both"] = field(
        "What says whether the stop is a test: the stop itself; or the same with the WSP bypassed, the rail;"
        " both: the stop itself, and the rail is shown beside it.",
        default="measured",
    )
    seed: int = field("Seed of noise and random rails.", default=0, ge=0, le=2**32 - 1, strict=True)
    repeat: Repeat = 1
    outcome_of_repeats: OutcomeOfRepeats = "all"
    simulation: Simulation = field("Step and longest duration.", default=Simulation())
    record: Record = field("Checks of a recorded stop.", default=Record())
    vary: dict[str, Any] | None = optional(
        "What `uictest sweep` varies: lists, ranges and distributions of values."
    )
    search: dict[str, Any] | None = optional(
        "Where `uictest search` looks for stops that fail; a run takes no notice of it."
    )

    def undescribed(self) -> Iterator[Inconsistency]:
        """Yield sources of its own numbers: parts describe sources, a scenario has none."""
        for key, source in unknown_sources(quantities_in(self, parts=False), ()):
            yield Inconsistency(
                key, f"unknown source {quoted(source)}", "leave it out: a scenario describes no sources"
            )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield values of different sections that do not fit together."""
        yield from super().inconsistencies()
        steps = self.controller.cycle_time / self.simulation.time_step
        if abs(steps - round(steps)) > 1e-9 * steps or steps < 1.0:
            yield Inconsistency(
                ("simulation", "time_step"),
                f"{self.simulation.time_step.text} does not divide the controller cycle of"
                f" {self.controller.cycle_time.text}",
                "take a whole part of the cycle, such as 0.5 ms of 10 ms",
            )
        if COMPENSATION_SETTINGS[self.rig.compensation].pressure == "filter":
            yield from unresolved_cylinder(self)
        yield from unresolved_air(self)
        yield from self._criteria_of_the_same_name()
        yield from self.expect.unknown_names(self.criteria)
        yield from self._delay_too_long()
        if self.tank_volume_with_caliper > 0.0:
            yield from self._step_too_long()
        else:
            yield Inconsistency(
                ("brake", "system"), "the balls leave no air in the tank of the caliper's module"
            )
        yield from self._calipers_that_are_not_there()
        yield from impossible_pole_wheels(self)
        yield from seeds_too_large(self.seed, self.repeat)
        yield from impossible_faults(self)
        yield from self._brake_too_strong()
        yield from impossible_courses(self)
        yield from impossible_sanders(self)
        yield from never_requested(self)
        yield from endless_stop(self)

    def _delay_too_long(self) -> Iterator[Inconsistency]:
        cycle, step = self.controller.cycle_time, self.simulation.time_step
        for key, delay in distinct_values(self, "wsp_valve.switching_delay"):
            if round(delay / step) >= (LONGEST_DELAY_CYCLES + 1) * round(cycle / step):
                yield Inconsistency(
                    key,
                    f"{delay.text} is too long for controller cycles of {cycle.text}",
                    f"less than {LONGEST_DELAY_CYCLES + 1} cycles are accepted",
                )

    def _step_too_long(self) -> Iterator[Inconsistency]:
        system = self.brake.system
        smallest_tank = min(system.tank.volume, self.tank_volume_with_caliper)
        valves = [
            (
                wheelset_value(self, number, "wsp_valve.fill_conductance"),
                wheelset_value(self, number, "wsp_valve.vent_conductance") + tank_leak(self, number),
            )
            for number in WHEELSET_NUMBERS
        ]
        step = self.simulation.time_step
        for key, limit in (
            (("vehicle",), limit_of_vehicle(self.vehicle)),
            (
                ("brake", "system"),
                limit_of_air(system, self.rig.caliper, smallest_tank, valves, line_leak(self)),
            ),
        ):
            if step > limit.longest:
                yield Inconsistency(
                    key if step.source == DEFAULT_SOURCE else ("simulation", "time_step"),
                    f"a step of {step.text} is too long for {limit.of}: the simulation could become unstable",
                    limit.hint,
                )

    def _brake_too_strong(self) -> Iterator[Inconsistency]:
        """Yield a brake that would need more adhesion than the largest friction coefficient gives."""
        if any(name not in self.brake.system.positions for _, _, name in self.brake.commands):
            return  # reported by the brake itself
        force = largest_clamping_force(self.rig.caliper, self.rig.compensation_model, self.highest_pressure)
        deceleration = largest_braking_force(self, force) / self.vehicle.total_mass
        if deceleration > STANDARD_GRAVITY:
            yield Inconsistency(
                ("brake",),
                f"the brake would slow this car of {self.vehicle.total_mass / 1000.0:.4g} t by"
                f" {deceleration:.3g} m/s2; no rail carries more than {STANDARD_GRAVITY:.3g} m/s2",
                "compare disc, pad, caliper, compensation_model and maximum_pressure with the mass of the"
                " vehicle",
            )

    def _criteria_of_the_same_name(self) -> Iterator[Inconsistency]:
        profile_of: dict[str, str] = {}
        if all(profile.name != RIG_CHECKS for profile in self.criteria):
            profile_of |= {criterion.id: RIG_CHECKS for criterion in rig_checks().criteria}
        profile_of |= dict.fromkeys(map(check_id, RecordTolerances.model_fields), "checks of a record")
        yield from criteria_of_the_same_name(self.criteria, profile_of)

    def _calipers_that_are_not_there(self) -> Iterator[Inconsistency]:
        """Yield values of a wheelset's own caliper where its module is a tank: nothing would read them."""
        if self.rig.topology != "one-caliper":
            return
        for number in WHEELSET_NUMBERS[1:]:
            own = self.vehicle.wheelsets[str(number)].caliper
            for name in sorted(own.model_fields_set):
                yield Inconsistency(
                    ("vehicle", "wheelsets", str(number), "caliper", name),
                    f"wheelset {number} has no caliper in the rig with one caliper: its module is a tank",
                    "write `rig.topology: four-caliper`, or leave it out",
                )

    @property
    def highest_pressure(self) -> float:
        """The highest pressure of the brake line that any command asks for at this load, gauge, Pa."""
        return self.brake.highest_commanded_pressure * load_share(self.brake.system.load_valve, self.vehicle)

    @property
    def developed_pressure(self) -> float:
        """Pressure of the brake line that shows a developed brake, Pa; NaN with a dynamic brake."""
        if self.brake.dynamic is not None:
            return math.nan
        return float(self.brake.commanded_pressure * load_share(self.brake.system.load_valve, self.vehicle))

    @property
    def judged_by(self) -> tuple[Criteria, ...]:
        """The profiles that judge a simulated stop: those that are named, and the checks of the rig."""
        if any(profile.name == RIG_CHECKS for profile in self.criteria):
            return self.criteria
        return (*self.criteria, rig_checks())

    @property
    def tank_volume_with_caliper(self) -> float:
        """Air volume of the caliper's module with the piston at the disc, m3."""
        tank, extra = self.brake.system.tank, self.brake.system.caliper_tank
        stroke = self.rig.caliper.piston_area * self.rig.caliper.clearance
        return tank.volume - extra.ball_volume + extra.hose_and_dead_volume + stroke
