"""Courses of a stop that cannot be: an end that is never reached, a speed that is never held."""

import math
from collections.abc import Iterator
from typing import Any

from uictest.plans.scenario.feasibility import highest_friction, stopping_time_at_least
from uictest.plans.scenario.parts.fault import SPEED
from uictest.plans.scenario.yaml import DEFAULT_SOURCE, Inconsistency


def impossible_courses(scenario: Any) -> Iterator[Inconsistency]:
    """Yield speeds at which the stop of a scenario cannot end or be held, and a load that is not known."""
    until, drag, begins = scenario.until, scenario.drag, scenario.initial_speed
    if scenario.brake.system.load_valve is not None and scenario.vehicle.payload is None:
        yield Inconsistency(
            ("brake", "system", "load_valve"),
            "the vehicle has no payload that the pressure could follow",
            "say what it carries when full: vehicle.payload: 8 t",
        )
    if until is not None and until >= begins:
        yield Inconsistency(
            ("until",),
            f"the stop begins at {begins.text}, not above {until.text}",
            "write a speed below initial_speed",
        )
    if drag is not None and drag.speed > begins:
        yield Inconsistency(
            ("drag", "speed"),
            f"the train begins at {begins.text} and comes to no higher speed",
            "write initial_speed or less",
        )
    yield from _never_reached(scenario)
    if drag is not None and until is not None and until >= drag.speed:
        yield Inconsistency(
            ("until",),
            f"the stop would end before {drag.speed.text} is held",
            "write a speed below drag.speed",
        )


def _never_reached(scenario: Any) -> Iterator[Inconsistency]:
    """Yield commands and faults behind the end of the stop."""
    longest, until = scenario.simulation.maximum_duration, scenario.until
    for place, (at, _, _) in enumerate(scenario.brake.commands):
        if at >= longest:
            yield Inconsistency(
                ("brake", "command", place, "at"),
                f"the stop ends after {longest.text} at the latest",
                "write an earlier time, or a longer simulation.maximum_duration",
            )
    for place, fault in enumerate(scenario.faults):
        if until is not None and fault.at.unit == SPEED and fault.at <= until:
            yield Inconsistency(
                ("faults", place, "at"),
                f"the stop ends at {until.text}, before {fault.at.text} is reached",
                "write a higher speed",
            )


def endless_stop(scenario: Any) -> Iterator[Inconsistency]:
    """Yield a stop that no brake can end within the longest duration that is simulated."""
    limit, shortest = scenario.simulation.maximum_duration, stopping_time_at_least(scenario)
    if shortest <= limit:
        return
    least = (
        "this car never stops" if shortest == math.inf else f"no brake stops this car within {shortest:.0f} s"
    )
    yield Inconsistency(
        ("initial_speed",) if limit.source == DEFAULT_SOURCE else ("simulation", "maximum_duration"),
        f"a stop from {scenario.initial_speed.text} cannot end within maximum_duration ({limit.text})",
        f"{least} with friction {highest_friction(scenario):g} and this gradient",
    )
