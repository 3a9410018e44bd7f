"""Whether a compensation fits: identified for the rig, and computed in steps that it can be."""

import math
from collections.abc import Callable, Iterable, Iterator
from typing import Any, Final, NamedTuple

from uictest.core.units import PERCENT
from uictest.plans.scenario.parts.brake import WspValve
from uictest.plans.scenario.parts.compensation import (
    CaliperAsBuilt,
    Compensation,
    RigAsBuilt,
    ValveAsBuilt,
)
from uictest.plans.scenario.parts.wheelsets import WHEELSET_NUMBERS, wheelset_value
from uictest.plans.scenario.yaml import Inconsistency, Quantity, Section, Source

FIT_KEYS: Final = (
    *("rig.topology", "rig.caliper", "rig.compensation_model"),
    *("brake.system.tank.volume", "brake.system.wsp_valve", "vehicle.wheelsets"),
)
"""Keys of a scenario at or below which :func:`rig_differences` reads."""

RIG_SOURCE: Final = "identified-for"
"""Source of the numbers of a listed rig."""
FIT_HINT: Final = "write `rig.compensation_model: identify` or `rig.topology: four-caliper`"
"""What to write where a compensation does not fit."""
_LEAST: Final = 1e-300
"""What a tolerance of a number that is zero is at least: any other number is beyond it."""


class RigDifference(NamedTuple):
    """A number of a rig beside that of the rig which a compensation was identified for.

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
    """Return what modules without a caliper stand for beside what their compensation was identified for.

    None where the compensation does not list its rig, or its numbers were changed since; empty where a
    caliper is in every module, and where the compensation is to be identified for this very rig. Numbers of
    several cases (:mod:`uictest.core.ensemble`) give differences of several.
    """
    if scenario.rig.topology != "one-caliper":
        return []
    model = scenario.rig.compensation_model
    if model.to_identify:
        return []
    rig = model.identified_for
    if rig is None or not _is_as_identified(model):
        return None
    return list(_differences(scenario, rig))


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
        for _, each in enumerate(value) if isinstance(value, tuple) else value:
            yield from _numbers_in(each)
    else:
        yield value


def _differences(scenario: Any, rig: RigAsBuilt) -> Iterator[RigDifference]:
    for name in CaliperAsBuilt.model_fields:
        sections = scenario.rig.caliper, rig.caliper, rig.tolerances.caliper
        yield RigDifference(f"rig.caliper.{name}", *(getattr(each, name) for each in sections))
    volume = scenario.brake.system.tank.volume
    yield RigDifference("brake.system.tank.volume", volume, rig.tank_volume, rig.tolerances.tank_volume)
    regular = scenario.brake.system.wsp_valve
    for name in WspValve.model_fields:
        expected, tolerance = (getattr(each, name) for each in (rig.wsp_valve, rig.tolerances.wsp_valve))
        yield RigDifference(f"brake.system.wsp_valve.{name}", getattr(regular, name), expected, tolerance)
        for number in WHEELSET_NUMBERS[1:]:
            own = wheelset_value(scenario, number, f"wsp_valve.{name}")
            if own is not getattr(regular, name):
                key = f"vehicle.wheelsets.{number}.wsp_valve.{name}"
                yield RigDifference(key, own, expected, tolerance)


def rig_as_built(scenario: Any) -> dict[str, Quantity]:
    """Return what a compensation lists of the rig that it was identified for, by the keys of a scenario."""
    caliper, system = scenario.rig.caliper, scenario.brake.system
    return {
        **{f"rig.caliper.{name}": getattr(caliper, name) for name in CaliperAsBuilt.model_fields},
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
