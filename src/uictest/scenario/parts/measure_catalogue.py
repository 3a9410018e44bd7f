"""The measures a criterion can bound: their kind, unit, and the definitions their words rest on."""

from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Literal

Course = Literal["grows", "falls", "settles"]
"""What a value can do while the stop goes on: only grow, only fall, or no more once there is one."""


@dataclass(frozen=True, slots=True)
class Measure:
    """One measure: the kind of quantity its bounds are, the unit it is printed in, its course, what it means.

    `definitions` names the parameters that a criterion must define before the words mean a number,
    `observed_by` the fields of the scenario's `measures` part that decide what is observed. A measure
    `of_simulation` says something about the simulation itself, nothing about a train.
    """

    kind: str
    unit: str
    course: Course
    meaning: str
    of_wheelsets: bool = False
    of_simulation: bool = False
    definitions: tuple[str, ...] = ()
    observed_by: tuple[str, ...] = ()


_SLIDING = ("sliding_slide", "sliding_slip", "moving_speed")
_LOCKING = ("locked_speed", "moving_speed")
_FILTERING = ("deceleration_filter", "moving_speed")


_OF_THE_STOP = {
    "braking_distance": Measure(
        "length",
        "m",
        "grows",
        "distance from the brake command to standstill, not corrected for the initial speed",
    ),
    "braking_time": Measure("time", "s", "grows", "time from the brake command to standstill"),
    "mean_deceleration": Measure(
        "acceleration", "m/s2", "falls", "v0^2 / (2 s), s the braking distance from v0"
    ),
    "standstill": Measure("number", "1", "settles", "1 where the train came to a standstill"),
    "initial_adhesion": Measure(
        "acceleration",
        "g",
        "settles",
        "mean deceleration of the train over the first phase, counted from the first sliding of any wheelset",
        definitions=("first_phase_duration",),
        observed_by=_SLIDING,
    ),
    "minimum_deceleration": Measure(
        "acceleration",
        "m/s2",
        "falls",
        "smallest filtered deceleration under developed braking",
        observed_by=(*_FILTERING, "developed_time"),
    ),
    "maximum_deceleration": Measure(
        "acceleration",
        "m/s2",
        "grows",
        "largest filtered deceleration while the train runs",
        observed_by=_FILTERING,
    ),
    "reservoir_minimum_pressure": Measure(
        "pressure", "bar", "falls", "lowest gauge pressure of the reservoir"
    ),
    "air_consumed": Measure(
        "normal volume", "NL", "grows", "air taken from the reservoir, normal volume (20 degC, 1 bar)"
    ),
    "energy_residual": Measure(
        "share",
        "%",
        "settles",
        "magnitude of the energy balance's error over the initial kinetic energy",
        of_simulation=True,
    ),
    "air_residual": Measure(
        "number",
        "1",
        "settles",
        "magnitude of the air balance's error over the mass taken",
        of_simulation=True,
    ),
}

_OF_WHEELSETS = {
    "maximum_slide_above_cutoff": Measure(
        "share",
        "%",
        "grows",
        "largest slide (v - r omega)/v while the train runs faster than the low-speed cut-off",
        of_wheelsets=True,
        definitions=("low_speed_cutoff",),
        observed_by=("moving_speed",),
    ),
    "locked_time": Measure(
        "time", "s", "grows", "time the wheelset is locked in all", of_wheelsets=True, observed_by=_LOCKING
    ),
    "longest_lock": Measure(
        "time",
        "s",
        "grows",
        "longest time the wheelset is locked at a stretch",
        of_wheelsets=True,
        observed_by=_LOCKING,
    ),
    "sliding_duration": Measure(
        "time", "s", "grows", "time the wheelset slides in all", of_wheelsets=True, observed_by=_SLIDING
    ),
    "valve_actuations": Measure(
        "number", "1", "grows", "openings and closings of the vent", of_wheelsets=True
    ),
    "maximum_clamping_force": Measure(
        "force", "kN", "grows", "largest clamping force of one caliper", of_wheelsets=True
    ),
    "air_vented": Measure(
        "normal volume", "NL", "grows", "air vented, normal volume (20 degC, 1 bar)", of_wheelsets=True
    ),
}

MEASURES: Final = MappingProxyType({**_OF_THE_STOP, **_OF_WHEELSETS})
"""Every measure by name."""
