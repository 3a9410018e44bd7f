"""Stops at 80, 90 and 100 % of the full command on a wet rail."""

from __future__ import annotations

from functools import partial

from studies.figures.levels import draw
from studies.phases import loops, slope_spread, slopes_table
from studies.quantity import OwnBand, StudyQuantity, StudyValue
from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings
from uictest.units import KILONEWTON, PERCENT

QUANTITIES = (
    StudyQuantity(
        "slope_spread",
        "largest change of a slope among the command levels",
        "%",
        "unchanged",
        # The simulated caliper knows no command: only what is identified of it could change.
        status="by construction",
        band=OwnBand(upper=5.0, reason="ours"),
    ),
    *(
        StudyQuantity(
            f"force_at_{level}",
            f"largest clamping force at {level} % command",
            "kN",
            status="by construction",
            digits=2,
        )
        for level in (80, 90, 100)
    ),
)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Identify the slopes at every command level."""
    stop_loops = loops(stop_runner, stop_runner.cases("wet-80-command"))
    forces = [StudyValue(loop.lines.largest_force / KILONEWTON) for loop in stop_loops]
    return StudyFindings(
        {
            "slope_spread": StudyValue(slope_spread(stop_loops) / PERCENT),
            **dict(zip(("force_at_80", "force_at_90", "force_at_100"), forces, strict=True)),
        },
        tables={"lines": slopes_table(stop_loops, "command")},
        drawings={"command-level": partial(draw, stop_loops, "command {}")},
    )


STUDY = Study(
    "command-level",
    "Force against pressure at 80, 90 and 100 % of the full command",
    "the command level does not change the slopes of force against pressure",
    QUANTITIES,
    run,
    position=50,
)
