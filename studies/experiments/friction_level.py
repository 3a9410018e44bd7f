"""Stops at full command with four initial friction coefficients."""

from __future__ import annotations

from functools import partial

from studies.figures.levels import draw
from studies.phases import loops, slope_spread, slopes_table
from studies.quantity import OwnBand, StudyQuantity, StudyValue
from studies.stop_runner import StopRunner, measured
from studies.study import Study, StudyFindings
from uictest.units import PERCENT

_LEVELS = ("009", "010", "011", "012")

QUANTITIES = (
    StudyQuantity(
        "slope_spread",
        "largest change of a slope among the friction coefficients",
        "%",
        # The simulated caliper knows no rail: only what is identified of it could change.
        status="by construction",
        band=OwnBand(upper=5.0, reason="ours"),
    ),
    *(
        StudyQuantity(
            f"distance_at_{level}", f"braking distance at {level[0]}.{level[1:]}", "m", status="predicted"
        )
        for level in _LEVELS
    ),
)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Identify the slopes at every friction coefficient, and the braking distances."""
    cases = stop_runner.cases("wet-80-friction")
    stop_loops = loops(stop_runner, cases)
    stops = stop_runner.repeated(cases, [0])
    distances = [StudyValue(measured(repeats.stops[0], "braking_distance_m")) for repeats in stops]
    return StudyFindings(
        {
            "slope_spread": StudyValue(slope_spread(stop_loops) / PERCENT),
            **dict(zip((f"distance_at_{level}" for level in _LEVELS), distances, strict=True)),
        },
        tables={"lines": slopes_table(stop_loops, "friction")},
        drawings={"friction-level": partial(draw, stop_loops, "friction {}")},
    )


STUDY = Study(
    "friction-level",
    "Force against pressure with initial friction coefficients from 0.09 to 0.12",
    "stops at full command with initial friction coefficients 0.09, 0.10, 0.11 and 0.12",
    QUANTITIES,
    run,
    position=60,
)
