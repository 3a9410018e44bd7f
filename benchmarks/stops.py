"""The stops that are timed: shipped scenarios."""

from pathlib import Path

from uictest.plans.scenario import load
from uictest.rig import StopInputs, assemble

SCENARIOS = Path(__file__).parent.parent / "scenarios"
TIMED = ("dry-120", "slide-80[compensation=full]", "low-adhesion-80")
"""Ids of the timed cases: nothing slides, some wheelsets slide, all slide and stand."""

Stop = StopInputs


def shipped() -> dict[str, Stop]:
    """Return every shipped case of a car alone by its id, with the paper's compensation.

    The C rig has no modelled air. The cases of slide-80 name their compensation themselves.
    """
    paths = [path for path in sorted(SCENARIOS.glob("*.yaml")) if path.name.count(".") == 1]
    named = [path for path in paths if path.stem == "slide-80"]
    cases = load([path for path in paths if path not in named], ["rig.compensation=full"]) + load(named)
    return {case.id: assemble(case) for case in cases if case.train is None}
