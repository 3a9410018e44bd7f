"""The compensation in place of a caliper, and whether it fits the rig."""

import math
from collections.abc import Callable, Iterable, Iterator
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, Final, Literal, NamedTuple

from uictest.core.units import BAR, PERCENT
from uictest.plans.scenario.parts.equipment import CaliperNumbers, Volume, WspValve
from uictest.plans.scenario.parts.vehicle import WHEELSET_NUMBERS, wheelset_value
from uictest.plans.scenario.yaml import (
    Inconsistency,
    Model,
    Part,
    Quantity,
    Section,
    Source,
    field,
    of_kind,
    optional,
    quantity,
    schema_field,
    total,
)

Coefficient = Annotated[Quantity, of_kind("number", "-1e6 .. 1e6")]
HeatConductance = Annotated[Quantity, of_kind("heat conductance", "0 W/K .. 1e4 W/K")]
ClosingPressure = Annotated[Quantity, of_kind("pressure", "0.001 bar .. 10 bar")]


class CompensationSetting(NamedTuple):
    """What computes the clamping force of a module without a caliper.

    Attributes:
        hysteresis: whether its force follows the four lines, or a single one.
        pressure: where the cylinder pressure comes from: the tank's reading as it is, the transfer function
            of equation (8), or the modelled air of the caliper's module.
    """

    hysteresis: bool
    pressure: Literal["tank", "filter", "air"]


COMPENSATION_SETTINGS: Final = MappingProxyType(
    {
        "none": CompensationSetting(hysteresis=False, pressure="tank"),
        "hysteresis": CompensationSetting(hysteresis=True, pressure="tank"),
        "cylinder": CompensationSetting(hysteresis=False, pressure="filter"),
        "full": CompensationSetting(hysteresis=True, pressure="filter"),
        "thermal": CompensationSetting(hysteresis=True, pressure="air"),
    }
)
"""Settings of ``rig.compensation``; all but `thermal` are those of Lee and Kang (2015)."""


class ForceLine(Section):
    """Clamping force as a straight line over gauge pressure, where it is positive."""

    slope: Quantity = quantity("Force per pressure.", "force per pressure", "0.001 kN/bar .. 1000 kN/bar")
    intercept: Quantity = quantity(
        "Force at zero gauge pressure; negative, because the spring must be overcome first.",
        "force",
        "-100 kN .. 100 kN",
    )

    def force(self, pressure: float) -> float:
        """Force in N at a gauge pressure in Pa."""
        return max(0.0, self.slope * pressure + self.intercept)


class FourPhaseHysteresis(Section):
    """Equations (4)-(7): a squeezing and a releasing line, one pair without and one with the WSP acting."""

    highest_pressure: ClassVar[float] = 10.0 * BAR
    """Gauge pressure, Pa, up to which the lines of a pair must keep their order; chosen."""

    bc_squeezing: ForceLine = field("Pressure rising, WSP not acting.")
    bc_releasing: ForceLine = field("Pressure falling, WSP not acting.")
    wsp_squeezing: ForceLine = field("Pressure rising, WSP acting.")
    wsp_releasing: ForceLine = field("Pressure falling, WSP acting.")
    transition_time: Quantity = quantity(
        "Time in which one pair of lines turns into the other, so that the force does not jump.",
        "time",
        "0 s .. 10 s",
    )
    wsp_acting_time: Quantity = quantity(
        "Time of uninterrupted filling after which the WSP no longer counts as acting.", "time", "0 s .. 60 s"
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield the pairs whose squeezing line is not below the releasing line."""
        pairs = (
            ("bc_squeezing", self.bc_squeezing, "bc_releasing", self.bc_releasing),
            ("wsp_squeezing", self.wsp_squeezing, "wsp_releasing", self.wsp_releasing),
        )
        for squeezing_key, squeezing, releasing_key, releasing in pairs:
            # Straight where positive: their order at the first force of the lower one and at the end decides.
            start = max(0.0, -squeezing.intercept / squeezing.slope)
            if any(squeezing.force(at) > releasing.force(at) for at in (start, self.highest_pressure)):
                yield Inconsistency(
                    (squeezing_key,),
                    "the squeezing line must lie below the releasing line wherever there is force",
                    f"compare its slope and intercept with {releasing_key}",
                )


class CylinderDynamics(Section):
    """Equation (8): (b0 + b1/z + b2/z2 + b3/z3) / (1 + a1/z + a2/z2 + a3/z3)."""

    gain_tolerance: ClassVar[float] = 1e-6
    """Largest difference of the gain at rest from one; chosen."""

    numerator: tuple[Coefficient, Coefficient, Coefficient, Coefficient] = field("b0, b1, b2, b3.")
    denominator: tuple[Coefficient, Coefficient, Coefficient] = field("a1, a2, a3.")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield an unstable denominator or a gain at rest that is not one."""
        if not _is_stable(*self.denominator):
            yield Inconsistency(
                ("denominator",),
                "the transfer function is unstable",
                "every pole must lie inside the unit circle",
            )
            return
        gain = total(self.numerator) / (1.0 + total(self.denominator))
        if abs(gain - 1.0) > self.gain_tolerance:
            yield Inconsistency(
                ("numerator",),
                f"the gain at rest is {gain:.9g}, not 1",
                "sum of numerator must equal 1 + sum of denominator",
            )


def _is_stable(a1: float, a2: float, a3: float) -> bool:
    """Jury's criterion for z3 + a1 z2 + a2 z + a3."""
    return (
        abs(a3) < 1.0
        and 1.0 + a1 + a2 + a3 > 0.0
        and 1.0 - a1 + a2 - a3 > 0.0
        and abs(a2 - a1 * a3) < 1.0 - a3 * a3
    )


class ModuleAir(Section):
    """Air that a caliper's module would hold, modelled for a tank: ours, not an equation of the paper."""

    tank_heat_conductance: HeatConductance = field("From the wall of a tank to its air.")
    caliper_heat_conductance: HeatConductance = field(
        "From the wall, and the balls, of the caliper's module to its air."
    )
    swept_volume: Quantity = quantity(
        "Volume that the piston sweeps until the pads touch the disc.", "volume", "0.001 L .. 10 L"
    )
    closing_pressure: ClosingPressure = field("At which the piston moves to the disc, gauge.")
    opening_pressure: ClosingPressure = field("At which the piston moves back, gauge.")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a piston that would move back before it moves out."""
        if self.opening_pressure > self.closing_pressure:
            yield Inconsistency(
                ("opening_pressure",),
                f"the piston would move back at {self.opening_pressure.text} and out at"
                f" {self.closing_pressure.text}",
                "opening_pressure must not exceed closing_pressure",
            )


Tolerance = Annotated[Quantity, of_kind("share", "> 0 % .. 100 %")]


class CaliperAsBuilt(CaliperNumbers, Section):
    """A brake cylinder with its lever and pads."""


class ValveAsBuilt(WspValve):
    """A WSP valve: fill, hold or vent one tank."""


def _tolerance_field(model: type[Model], name: str) -> Any:
    return field(model.model_fields[name].description or "")


class CaliperTolerances(Section):
    """A brake cylinder with its lever and pads."""

    piston_area: Tolerance = _tolerance_field(CaliperNumbers, "piston_area")
    preload: Tolerance = _tolerance_field(CaliperNumbers, "preload")
    spring_rate: Tolerance = _tolerance_field(CaliperNumbers, "spring_rate")
    coulomb_friction: Tolerance = _tolerance_field(CaliperNumbers, "coulomb_friction")
    load_friction: Tolerance = _tolerance_field(CaliperNumbers, "load_friction")
    viscous_friction: Tolerance = _tolerance_field(CaliperNumbers, "viscous_friction")
    contact_friction: Tolerance = _tolerance_field(CaliperNumbers, "contact_friction")
    clearance: Tolerance = _tolerance_field(CaliperNumbers, "clearance")
    contact_stiffness: Tolerance = _tolerance_field(CaliperNumbers, "contact_stiffness")
    lever_ratio: Tolerance = _tolerance_field(CaliperNumbers, "lever_ratio")


class ValveTolerances(Section):
    """A WSP valve: fill, hold or vent one tank."""

    fill_conductance: Tolerance = _tolerance_field(WspValve, "fill_conductance")
    vent_conductance: Tolerance = _tolerance_field(WspValve, "vent_conductance")
    switching_delay: Tolerance = _tolerance_field(WspValve, "switching_delay")
    travel_time: Tolerance = _tolerance_field(WspValve, "travel_time")


class RigTolerances(Section):
    """Tolerances, as shares, of a rig against the one that a compensation was identified for."""

    caliper: CaliperTolerances = field("Of the caliper.")
    wsp_valve: ValveTolerances = field("Of the WSP valve.")
    tank_volume: Tolerance = field("Of the volume of an empty tank.")


class RigAsBuilt(Section):
    """The rig that a compensation was identified for, as built: without faults."""

    caliper: CaliperAsBuilt = field("Its caliper.")
    wsp_valve: ValveAsBuilt = field("Its WSP valves.")
    tank_volume: Volume = field("Volume of an empty tank.")
    tolerances: RigTolerances = field("How far another rig may differ from it.")


class Compensation(Part):
    """The model that computes clamping force from the tank pressure of a module without caliper."""

    folder: ClassVar[str] = "compensations"

    schema_id: Literal["uictest/compensation/1"] = schema_field("uictest/compensation/1")
    sampling_time: Quantity = quantity("Sampling time of the cylinder dynamics.", "time", "0.01 ms .. 10 ms")
    linear: ForceLine = field("Force over pressure without hysteresis, used by the setting 'none'.")
    hysteresis: FourPhaseHysteresis = field("Four-phase hysteresis.")
    cylinder: CylinderDynamics = field("Tank pressure to cylinder pressure.")
    air: ModuleAir = field("Air of the caliper's module, used by the setting 'thermal'.")
    identified_for: RigAsBuilt | None = optional(
        "The rig that it was identified for; none: not known, so that no stop is checked for it."
    )
    to_identify: bool = field(
        "Whether the numbers only stand in: others are identified from the bench for the rig.",
        default=False,
        strict=True,
    )
    provenance: dict[str, str] = field(
        "How the numbers were identified, as text by topic.", default_factory=dict
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a compensation to identify whose tolerances, which the identified one takes, are missing."""
        yield from super().inconsistencies()
        if self.to_identify and self.identified_for is None:
            yield Inconsistency(
                ("identified_for",),
                "a compensation with `to_identify` has no `identified_for`, whose tolerances it is held to",
                "extend `identify`, or list the rig of the numbers that stand in",
            )


RIG_SOURCE: Final = "identified-for"
"""Source of the numbers of a listed rig."""
FIT_HINT: Final = "write `rig.compensation_model: identify` or `rig.topology: four-caliper`"
"""Hint for a compensation that does not fit the rig."""
_LEAST: Final = 1e-300
"""Least tolerance of a number that is zero: any other number is beyond it."""


class RigDifference(NamedTuple):
    """A number of a rig compared with that of the rig which a compensation was identified for.

    Args:
        key: of the scenario.
        found: in the rig.
        identified: in the rig that the compensation was identified for.
        tolerance: as a share of `identified`.

    """

    key: str
    found: Any
    identified: Any
    tolerance: Any

    @property
    def share(self) -> Any:
        """The difference as a share of its tolerance."""
        return abs(self.found - self.identified) / max(self.tolerance * self.identified, _LEAST)

    @property
    def sentence(self) -> str:
        """Both values and the tolerance for a reader, to be read after the key."""
        found, identified = (
            each.text if isinstance(each, Quantity) else f"{each:.6g}"
            for each in (self.found, self.identified)
        )
        tolerance = f"{self.tolerance / PERCENT:g} %"
        return f"is {found}, the compensation is for {identified} within {tolerance}"

    def __str__(self) -> str:
        """Return key, both values and the tolerance for a reader."""
        return f"{self.key} {self.sentence}"


def rig_differences(scenario: Any) -> list[RigDifference] | None:
    """Return the numbers of the simulated rig compared with those that its compensation was identified for.

    None where the compensation does not list its rig, or its numbers were changed since; empty where a
    caliper is in every module, and where the compensation is to be identified for this very rig.
    """
    if scenario.rig.topology != "one-caliper":
        return []
    model = scenario.rig.compensation_model
    if model.to_identify:
        return []
    rig = model.identified_for
    if rig is None or not _is_as_identified(model):
        return None
    return list(_differences_of_rigs(scenario, rig))


def _is_as_identified(model: Compensation) -> bool:
    """Return whether each number has a source of the compensation: one that is set by a scenario has none."""
    sections = model.linear, model.hysteresis, model.cylinder, model.air
    return all(
        isinstance(each, Quantity) and each.source in model.sources
        for section in sections
        for each in _numbers_in(section)
    )


def _numbers_in(value: Any) -> Iterator[Any]:
    if isinstance(value, Section | tuple):
        for _, item in enumerate(value) if isinstance(value, tuple) else value:
            yield from _numbers_in(item)
    else:
        yield value


def _differences_of_rigs(scenario: Any, rig: RigAsBuilt) -> Iterator[RigDifference]:
    for name in CaliperNumbers.model_fields:
        sections = scenario.rig.caliper, rig.caliper, rig.tolerances.caliper
        yield RigDifference(f"rig.caliper.{name}", *(getattr(section, name) for section in sections))
    volume = scenario.brake.system.tank.volume
    yield RigDifference("brake.system.tank.volume", volume, rig.tank_volume, rig.tolerances.tank_volume)
    regular = scenario.brake.system.wsp_valve
    for name in WspValve.model_fields:
        expected, tolerance = (getattr(each, name) for each in (rig.wsp_valve, rig.tolerances.wsp_valve))
        yield RigDifference(f"brake.system.wsp_valve.{name}", getattr(regular, name), expected, tolerance)
        for number in WHEELSET_NUMBERS[1:]:
            of_wheelset = wheelset_value(scenario, number, f"wsp_valve.{name}")
            if of_wheelset is not getattr(regular, name):
                key = f"vehicle.wheelsets.{number}.wsp_valve.{name}"
                yield RigDifference(key, of_wheelset, expected, tolerance)


def rig_as_built(scenario: Any) -> dict[str, Quantity]:
    """Return the numbers of a rig that a compensation lists: dotted key of a scenario -> quantity."""
    caliper, system = scenario.rig.caliper, scenario.brake.system
    return {
        **{f"rig.caliper.{name}": getattr(caliper, name) for name in CaliperNumbers.model_fields},
        "brake.system.tank.volume": system.tank.volume,
        **{
            f"brake.system.wsp_valve.{name}": getattr(system.wsp_valve, name)
            for name in WspValve.model_fields
        },
    }


def with_listed_rig(model: Compensation, scenario: Any) -> Compensation:
    """Return a compensation that lists the rig of a scenario, with the tolerances of what stood in for it."""
    stated = scenario.rig.compensation_model
    sections: dict[str, dict[str, Any]] = {"caliper": {}, "wsp_valve": {}, "tank": {}}
    for key, value in rig_as_built(scenario).items():
        section, name = key.split(".")[-2:]
        sections[section][name] = Quantity(value, value.text, value.unit, RIG_SOURCE)
    rig = RigAsBuilt.model_construct(
        caliper=CaliperAsBuilt.model_construct(**sections["caliper"]),
        wsp_valve=ValveAsBuilt.model_construct(**sections["wsp_valve"]),
        tank_volume=sections["tank"]["volume"],
        tolerances=stated.identified_for.tolerances,
    )
    listed = {RIG_SOURCE: Source(mark="identified", text="The rig of the bench, as built")}
    sources = {**stated.sources, **model.sources, **listed}
    return model.model_copy(update={"identified_for": rig, "sources": sources})


def misfit(differences: Iterable[RigDifference], larger: Callable[[Any, Any], Any] = max) -> Any:
    """Return the sum of the differences over their tolerances: beyond 1 the compensation does not fit.

    Several numbers that differ the same way move a stop further than each of them does. A number of the
    valves counts once, with the largest difference of all modules. `larger` returns the larger of two shares.
    """
    shares: dict[tuple[str, ...], Any] = {}
    for each in differences:
        name = tuple(each.key.split(".")[-2:])
        shares[name] = larger(shares.get(name, 0.0), each.share)
    return sum(shares.values(), 0.0)


def misfits(scenario: Any) -> list[RigDifference]:
    """Return the differences that make a compensation unfit, the largest first; none where it fits."""
    differences = [each for each in rig_differences(scenario) or () if each.share > 0.0]
    return sorted(differences, key=lambda each: -each.share) if misfit(differences) > 1.0 else []


_SMALLEST_SUM_AT_REST: Final = 1e-12
"""1 + a1 + a2 + a3 below which rounding moves the gain at rest by more than one part in ten thousand."""


def unresolved_cylinder(scenario: Any) -> Iterator[Inconsistency]:
    """Yield a step at which double precision cannot hold the gain at rest of the cylinder dynamics.

    The gain is a quotient of sums that shrink with the third power of the step.
    """
    model = scenario.rig.compensation_model
    shrink = (scenario.simulation.time_step / model.sampling_time) ** 3
    sum_at_rest = shrink * (1.0 + math.fsum(model.cylinder.denominator))
    if sum_at_rest < _SMALLEST_SUM_AT_REST:
        yield Inconsistency(
            ("simulation", "time_step"),
            f"{scenario.simulation.time_step.text} is too short for the cylinder dynamics identified at"
            f" {model.sampling_time.text}: double precision cannot hold their gain at rest",
            "take a longer step or rig.compensation: none",
        )


def unresolved_air(scenario: Any) -> Iterator[Inconsistency]:
    """Yield modelled air that a step would overheat, and a piston that sweeps a whole tank.

    What flows from the wall within a step must stay below what air of atmospheric pressure can hold.
    """
    model, system = scenario.rig.compensation_model.air, scenario.brake.system
    warmed = scenario.simulation.time_step * system.air.temperature * (system.air.heat_capacity_ratio - 1.0)
    at_rest = system.tank.volume - model.swept_volume
    largest = max(system.air.atmospheric_pressure * at_rest / warmed, 0.0)
    for key, conductance in (
        ("tank_heat_conductance", model.tank_heat_conductance),
        ("caliper_heat_conductance", model.caliper_heat_conductance),
    ):
        if conductance > largest:
            yield Inconsistency(
                ("rig", "compensation_model", "air", key),
                f"{conductance.text} is too much for {system.tank.volume.text} of air and steps of"
                f" {scenario.simulation.time_step.text}",
                f"at most {largest:.3g} W/K are accepted",
            )
    if model.swept_volume >= system.tank.volume:
        yield Inconsistency(
            ("rig", "compensation_model", "air", "swept_volume"),
            f"a piston that sweeps {model.swept_volume.text} leaves no air in a tank of"
            f" {system.tank.volume.text}",
            "it must be below brake.system.tank.volume",
        )
