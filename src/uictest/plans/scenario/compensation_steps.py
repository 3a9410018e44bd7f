"""Steps that a compensation cannot be computed at."""

import math
from collections.abc import Iterator
from typing import Any, Final

from uictest.plans.scenario.yaml import Inconsistency

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
