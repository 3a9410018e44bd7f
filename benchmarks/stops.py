"""The stops that are timed: shipped scenarios."""

from pathlib import Path

from uictest.rig import StopInputs, assemble
from uictest.scenario import load

SCENARIOS = Path(__file__).parent.parent / "scenarios"
TIMED = ("dry-120", "slide-80[compensation=full]", "low-adhesion-80")
"""Ids of the timed cases: nothing slides, some wheelsets slide, all slide and stand."""

Stop = StopInputs


def shipped() -> dict[str, Stop]:
    """Return every shipped case by its id."""
    return {case.id: assemble(case) for case in load([SCENARIOS])}
