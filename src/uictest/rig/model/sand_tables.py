"""Sanders in the parameter record: what each lays and when, and what sand does on the rail."""

from collections.abc import MutableSequence
from typing import Annotated

from uictest.core.physics import MOST_SAND_POINTS
from uictest.core.record import Record, derived

SanderTable = Annotated[MutableSequence[float], 4]
"""A number for the sander of each wheelset; zero where there is none."""
SandTable = Annotated[MutableSequence[float], MOST_SAND_POINTS]


class SandTables(Record):
    """Fields of the parameter record that :mod:`uictest.rig.model.sand` reads; all zero without sanders."""

    has_sanders: float = derived()  # 0 or 1; in a train 1 in every car if one has a sander
    sander_rates: SanderTable = derived()  # largest, kg/s
    sander_densities: SanderTable = derived()  # largest, kg/m; infinite: the rate alone counts
    sander_distances: SanderTable = derived()  # of the nozzle ahead of the wheelset, m
    sander_delays: SanderTable = derived()  # controller cycles from the demand to sand on the rail
    sander_off_speeds: SanderTable = derived()  # train speed below which none is demanded, m/s
    # what demands sand: 0 or 1
    sanders_always: SanderTable = derived()
    sanders_on_slide: SanderTable = derived()
    sanders_on_request: SanderTable = derived()
    sander_slide_cycles: SanderTable = derived()  # of a WSP that acts, after which wheels slide
    sander_run_on_cycles: SanderTable = derived()  # of a WSP that rests, after which they do no more
    # on the rail
    sand_points_per_metre: float = derived()  # grid, 1/m
    sand_kept: float = derived()  # share that a wheelset leaves
    sand_friction: float = derived()  # initial friction coefficient with enough sand
    sand_points: int = derived()  # of the table
    sand_densities: SandTable = derived()  # kg/m
    sand_shares: SandTable = derived()  # of the way to the friction with enough sand
