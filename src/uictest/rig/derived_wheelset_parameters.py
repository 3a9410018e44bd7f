"""Parameters of a wheelset that follow from several values, its own or the regular ones.

Each function states the values of a wheelset (:func:`~uictest.plans.scenario.wheelset_value`) and the further
keys of the scenario at or below which it reads.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from uictest.core.ensemble import case_by_case
from uictest.core.physics import stiffnesses
from uictest.core.record import scenario_values
from uictest.plans.scenario import WHEELSET_NUMBERS, Scenario, wheelset_keys, wheelset_value
from uictest.rig.derived_parameters import Assignment
from uictest.rig.model.wheelset_parameters import WheelsetParameters

ValueOf = Callable[[str], Any]
"""Returns a value of the wheelset by its name."""
_Set = Callable[[WheelsetParameters, ValueOf, Scenario], None]


class _Rule(NamedTuple):
    """What sets some fields of a wheelset; the names of the values and the further keys that it reads."""

    apply: _Set
    values: tuple[str, ...]
    keys: tuple[str, ...] = ()

    def of(self, number: int) -> Assignment:
        """Return the assignment for one wheelset."""

        def assign(own: WheelsetParameters, scenario: Scenario) -> None:
            self.apply(own, lambda name: wheelset_value(scenario, number, name), scenario)

        keys = (key for name in self.values for key in wheelset_keys(number, name))
        return Assignment(assign, (*keys, *self.keys))


_DERIVED: list[_Rule] = []


def _reads(*values: str, keys: tuple[str, ...] = ()) -> Callable[[_Set], _Set]:
    """Register a function, the values of a wheelset and the further keys that it reads."""

    def register(function: _Set) -> _Set:
        _DERIVED.append(_Rule(function, values, keys))
        return function

    return register


@_reads("wheel_radius", "rotational_inertia", keys=("vehicle.wheelset.mass", "simulation.time_step"))
def _slip(own: WheelsetParameters, value: ValueOf, scenario: Scenario) -> None:
    """What a moment and a creep force change within one step, and the inverses."""
    radius, step = value("wheel_radius"), float(scenario.simulation.time_step)
    own.inertia_response = step / value("rotational_inertia")
    own.inertia_stiffness = 1.0 / own.inertia_response
    own.slip_response = step / scenario.vehicle.wheelset.mass + radius * radius * own.inertia_response
    own.slip_stiffness = 1.0 / own.slip_response


@_reads("caliper.load_friction", keys=("rig.caliper", "simulation.time_step"))
def _caliper(own: WheelsetParameters, value: ValueOf, scenario: Scenario) -> None:
    caliper = scenario.rig.caliper
    _, _, own.squeezing_stiffness, own.releasing_stiffness, _, *compliances = case_by_case(
        stiffnesses,
        caliper.spring_rate,
        value("caliper.load_friction"),
        caliper.viscous_friction,
        caliper.contact_friction,
        caliper.contact_stiffness,
        scenario.simulation.time_step,
    )
    own.squeezing_compliance, own.releasing_compliance = compliances


@_reads("wsp_valve.travel_time", keys=("simulation.time_step",))
def _valve_travel(own: WheelsetParameters, value: ValueOf, scenario: Scenario) -> None:
    step = float(scenario.simulation.time_step)
    own.valve_travel_per_step = min(step / max(value("wsp_valve.travel_time"), step), 1.0)


@_reads("wsp_valve.switching_delay", keys=("simulation.time_step", "controller.cycle_time"))
def _valve_delay(own: WheelsetParameters, value: ValueOf, scenario: Scenario) -> None:
    """Switching delay in whole controller cycles and the steps that remain."""
    step = float(scenario.simulation.time_step)
    steps_per_cycle = round(float(scenario.controller.cycle_time) / step)
    own.valve_delay_cycles, own.valve_delay_steps = divmod(
        round(value("wsp_valve.switching_delay") / step), steps_per_cycle
    )


@_reads("configured_radius", "sensors.speed.teeth")
def _speed_sensor(own: WheelsetParameters, value: ValueOf, scenario: Scenario) -> None:
    own.tooth_pitch = 2.0 * math.pi * value("configured_radius") / value("sensors.speed.teeth")


@_reads("sensors.speed.method")
def _method(own: WheelsetParameters, value: ValueOf, scenario: Scenario) -> None:
    own.counts_teeth = float(value("sensors.speed.method") == "whole-teeth")


def _copying(field: str, name: str) -> _Rule:
    """Set one field to the value of one name."""

    def copy(own: WheelsetParameters, value: ValueOf, scenario: Scenario) -> None:
        setattr(own, field, value(name))

    return _Rule(copy, (name,))


_RULES = (
    *(_copying(field, source.key) for field, source in scenario_values(WheelsetParameters).items()),
    *_DERIVED,
)
WHEELSET_ASSIGNMENTS: tuple[tuple[Assignment, ...], ...] = tuple(
    tuple(rule.of(number) for rule in _RULES) for number in WHEELSET_NUMBERS
)
"""For each wheelset, what sets all of its parameters."""
