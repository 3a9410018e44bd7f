"""Stops at 80, 90 and 100 % of the full command on a wet rail."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from uictest.studies.figures.levels import draw
from uictest.studies.quantity import Quantity, Reading
from uictest.studies.slopes import loops, slope_spread, slopes_table
from uictest.studies.study import Findings, Study
from uictest.studies.units import KILONEWTON, PERCENT

if TYPE_CHECKING:
    from uictest.studies.laboratory import Laboratory

QUANTITIES = (
    Quantity(
        "slope_spread",
        "largest change of a slope among the command levels",
        "%",
        "unchanged",
        upper=5.0,
        reason="ours",
    ),
    Quantity("force_at_80", "largest clamping force at 80 % command", "kN", digits=2),
    Quantity("force_at_90", "largest clamping force at 90 % command", "kN", digits=2),
    Quantity("force_at_100", "largest clamping force at 100 % command", "kN", digits=2),
)


def conduct(laboratory: Laboratory) -> Findings:
    """Find the slopes at every command level."""
    found = loops(laboratory, laboratory.cases("wet-80-command"))
    forces = [Reading(loop.lines.largest_force / KILONEWTON) for loop in found]
    return Findings(
        {
            "slope_spread": Reading(slope_spread(found) / PERCENT),
            **dict(zip(("force_at_80", "force_at_90", "force_at_100"), forces, strict=True)),
        },
        tables={"lines": slopes_table(found, "command")},
        drawings={"command-level": partial(draw, found, "command {}")},
    )


STUDY = Study(
    "command-level",
    "Force against pressure at 80, 90 and 100 % of the full command",
    "the command level does not change the slopes of force against pressure",
    QUANTITIES,
    conduct,
)
