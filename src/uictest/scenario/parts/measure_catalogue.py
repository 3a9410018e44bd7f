"""The measures a criterion can bound: their kind, unit, and the definitions their words rest on."""

from dataclasses import dataclass
from types import MappingProxyType
from typing import Final


@dataclass(frozen=True, slots=True)
class Measure:
    """One measure: the kind of quantity its bounds are, the unit it is printed in, what it means.

    `definitions` names the parameters that a criterion must define before the words mean a number,
    `observed_by` the fields of the scenario's `measures` part that decide what is observed.
    """

    kind: str
    unit: str
    meaning: str
    of_wheelsets: bool = False
    definitions: tuple[str, ...] = ()
    observed_by: tuple[str, ...] = ()


_SLIDING = ("sliding_slide", "sliding_slip", "moving_speed")
_LOCKING = ("locked_speed", "moving_speed")
_FILTERING = ("deceleration_filter", "moving_speed")


_OF_THE_STOP = {
    "braking_distance": Measure(
        "length", "m", "distance from the brake command to standstill, not corrected for the initial speed"
    ),
    "braking_time": Measure("time", "s", "time from the brake command to standstill"),
    "mean_deceleration": Measure("acceleration", "m/s2", "v0^2 / (2 s), s the braking distance from v0"),
    "standstill": Measure("number", "1", "1 where the train came to a standstill, else 0"),
    "initial_adhesion": Measure(
        "acceleration",
        "g",
        "mean deceleration of the train over the first phase, counted from the first sliding of any wheelset",
        definitions=("first_phase_duration",),
        observed_by=_SLIDING,
    ),
    "minimum_deceleration": Measure(
        "acceleration",
        "m/s2",
        "smallest filtered deceleration under developed braking",
        observed_by=(*_FILTERING, "developed_time"),
    ),
    "maximum_deceleration": Measure(
        "acceleration", "m/s2", "largest filtered deceleration while the train runs", observed_by=_FILTERING
    ),
    "reservoir_minimum_pressure": Measure("pressure", "bar", "lowest gauge pressure of the reservoir"),
    "air_consumed": Measure("volume", "NL", "air taken from the reservoir, normal volume (20 degC, 1 bar)"),
    "energy_residual": Measure(
        "share", "%", "magnitude of the energy balance's error over the initial kinetic energy"
    ),
    "air_residual": Measure("number", "1", "magnitude of the air balance's error over the mass taken"),
}

_OF_WHEELSETS = {
    "maximum_slide": Measure(
        "share",
        "%",
        "largest slide (v - r omega)/v while the train runs faster than the low-speed cut-off",
        of_wheelsets=True,
        definitions=("low_speed_cutoff",),
        observed_by=("moving_speed",),
    ),
    "locked_time": Measure(
        "time", "s", "time the wheelset is locked in all", of_wheelsets=True, observed_by=_LOCKING
    ),
    "longest_lock": Measure(
        "time",
        "s",
        "longest time the wheelset is locked at a stretch",
        of_wheelsets=True,
        observed_by=_LOCKING,
    ),
    "sliding_duration": Measure(
        "time", "s", "time the wheelset slides in all", of_wheelsets=True, observed_by=_SLIDING
    ),
    "valve_actuations": Measure("number", "1", "openings and closings of the vent", of_wheelsets=True),
    "maximum_clamping_force": Measure(
        "force", "kN", "largest clamping force of one caliper", of_wheelsets=True
    ),
    "air_vented": Measure("volume", "NL", "air vented, normal volume (20 degC, 1 bar)", of_wheelsets=True),
}

MEASURES: Final = MappingProxyType({**_OF_THE_STOP, **_OF_WHEELSETS})
"""Every measure by name."""
