"""The stops that are timed: shipped scenarios."""

from pathlib import Path

from uictest.plans.scenario import load
from uictest.rig import StopInputs, assemble

SCENARIOS = Path(__file__).parent.parent / "scenarios"

Stop = StopInputs


def slide_test() -> Stop:
    """Return the slide test with the paper's compensation: some wheelsets slide."""
    [case] = load([SCENARIOS / "slide-80.yaml"], ["rig.compensation=full"])
    return assemble(case)
