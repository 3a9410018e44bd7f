"""Parameters of the sanders and of sand on the rail; all zero without sanders."""

import math
from collections.abc import Callable
from typing import Final

from uictest.core.physics import MOST_SAND_POINTS
from uictest.plans.scenario import WHEELSET_NUMBERS, Sander, Scenario
from uictest.rig.derived_parameters import Assignment
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail import MARGIN, POINTS

_GAIN_OF_SPEED: Final = 1.5
"""Largest speed over the initial one for which the rings have room; chosen: no braked train gains so much."""


def sand_grid(largest_gap: float, initial_speed: float, cycle_time: float) -> float:
    """Return the points per metre of a grid whose rings hold a gap and what is run in a controller cycle.

    Args:
        largest_gap: between two wheelsets, m.
        initial_speed: m/s.
        cycle_time: s.
    """
    return (POINTS - 2 * MARGIN) / (largest_gap + _GAIN_OF_SPEED * initial_speed * cycle_time)


def _set_sanders(p: Parameters, scenario: Scenario) -> None:
    sanders = {sander.wheelset: sander for sander in scenario.sanders}
    cycle = float(scenario.controller.cycle_time)

    def table(of: Callable[[Sander], float]) -> list[float]:
        return [of(sanders[number]) if number in sanders else 0.0 for number in WHEELSET_NUMBERS]

    p.has_sanders = float(bool(sanders))
    p.sander_rates = table(lambda sander: sander.largest_rate)
    p.sander_densities = table(lambda sander: math.inf if sander.density is None else float(sander.density))
    p.sander_distances = table(lambda sander: float(sander.distance))
    p.sander_delays = table(lambda sander: round(sander.delay / cycle))
    p.sander_off_speeds = table(lambda sander: float(sander.off_below))
    p.sanders_always = table(lambda sander: float(sander.when == "always"))
    p.sanders_on_slide = table(lambda sander: float(sander.when == "sliding"))
    p.sanders_on_request = table(lambda sander: float(sander.when == "requested"))
    p.sander_slide_cycles = table(lambda sander: round(sander.sliding_time / cycle))
    p.sander_run_on_cycles = table(lambda sander: round(sander.run_on / cycle))


def _set_sand(p: Parameters, scenario: Scenario) -> None:
    points = scenario.rail.sand.points if scenario.sanders else ()
    blank = [0.0] * (MOST_SAND_POINTS - len(points))
    p.sand_points = len(points)
    p.sand_densities = [*(float(point.density) for point in points), *blank]
    p.sand_shares = [*(float(point.share) for point in points), *blank]
    p.sand_friction = p.sand_kept = p.sand_points_per_metre = 0.0
    if points:
        p.sand_friction, p.sand_kept = float(scenario.rail.sand.friction), float(scenario.rail.sand.kept)
        wheelbase = 2.0 * float(scenario.vehicle.bogie.half_wheelbase)
        gap = max(wheelbase, 2.0 * float(scenario.vehicle.half_pivot_distance) - wheelbase)
        p.sand_points_per_metre = sand_grid(
            gap, float(scenario.initial_speed), float(scenario.controller.cycle_time)
        )


SANDERS: Final[tuple[Assignment, ...]] = (
    Assignment(_set_sanders, ("sanders", "controller.cycle_time")),
    Assignment(
        _set_sand,
        (
            *("sanders", "rail.sand", "vehicle.bogie", "vehicle.half_pivot_distance"),
            *("initial_speed", "controller.cycle_time"),
        ),
    ),
)
"""What sets the parameters of sanders and sand."""
