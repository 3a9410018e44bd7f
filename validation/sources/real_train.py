"""The two numbers of the real train, and two of its decelerations, that the source states."""

from __future__ import annotations

from statistics import median

from studies.stop_runner import StopRunner, measured
from validation.source import Comparison, Findings, Source

SEEDS = range(10)
_MEASURED = (
    ("braking time", "s", 17.6, "braking_time_s", True, 1),
    ("braking distance", "m", 197.0, "braking_distance_m", True, 1),
    ("least deceleration", "m/s²", 0.98, "minimum_deceleration_mps2", False, 2),
    ("greatest deceleration", "m/s²", 1.52, "maximum_deceleration_mps2", False, 2),
)
"""Quantity, unit, the source's value, our measure, whether the calibration asked for it, digits."""


def run(stop_runner: StopRunner) -> Findings:
    """Compare the medians of the slide test of the library with the train's."""
    stops = stop_runner.repeated(stop_runner.cases("slide-80"), SEEDS)[0].stops
    values = {name: [measured(stop, name) for stop in stops] for _, _, _, name, _, _ in _MEASURED}
    ranges = [
        f"{quantity} {min(values[name]):.{digits}f} to {max(values[name]):.{digits}f} {unit}"
        for quantity, unit, _, name, _, digits in _MEASURED
    ]
    return Findings(
        [
            Comparison(quantity, unit, source, median(values[name]), fitted, digits)
            for quantity, unit, source, name, fitted, digits in _MEASURED
        ],
        notes=(f"Medians of {len(SEEDS)} seeds of the sensors' noise; over the seeds {', '.join(ranges)}.",),
    )


SOURCE = Source(
    name="real-train",
    title="Slide test of a real train from 80 km/h",
    place=(
        "Lee and Kang, Advances in Mechanical Engineering 7(11), 2015, doi 10.1177/1687814015616086, text "
        "on the slide test"
    ),
    kind="measured",
    fitted=(
        "Friction of the rail (0.1651), pressure of the emergency application, valves and thresholds of "
        "the WSP: time and distance were targets of the calibration. The decelerations were not"
    ),
    shows="One setting of the rig meets the time and the distance of this stop at once.",
    does_not_show=(
        "That the rig would predict a stop of this train: friction, load and filter of the train's record "
        "are not public, and the decelerations, which nothing was fitted to, depend on that filter."
    ),
    run=run,
)
