"""Conditions of the stops that the compensation is judged on; neither training nor calibration uses them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import Field

from studies.stop_runner import StopRunner, seeded
from uictest.plans.scenario import Case, yaml

_FILE = Path(__file__).parent / "conditions" / "judgement.yaml"


class JudgedConditions(yaml.Model):
    """Every combination of a friction, a position, a wheelset and a seed is judged."""

    frictions: tuple[Annotated[float, Field(gt=0.0, le=1.0)], ...] = Field(
        min_length=1, description="Initial friction coefficients of the rail."
    )
    positions: tuple[str, ...] = Field(min_length=1, description="Brake positions.")
    wheelsets: tuple[Annotated[int, Field(ge=1, le=4)], ...] = Field(
        min_length=1, description="Wheelsets whose valve commands are replayed."
    )
    seeds: tuple[Annotated[int, Field(ge=0)], ...] = Field(
        min_length=1, description="Seeds of the sensors' noise."
    )


def judged_conditions() -> JudgedConditions:
    """Return the conditions of the file."""
    tree = yaml.read_file(_FILE)
    conditions: JudgedConditions = yaml.validated(JudgedConditions, yaml.plain(tree), tree)
    return conditions


def judged_cases(stop_runner: StopRunner, conditions: JudgedConditions) -> list[Case]:
    """Return the slide test at every friction and in every position, under every seed.

    Every module has a caliper, so that the valve commands do not depend on a compensation.
    """
    frictions = ",".join(map(str, conditions.frictions))
    positions = ",".join(conditions.positions)
    cases = stop_runner.cases(
        "slide-80-four-caliper", f"rail.friction={frictions}", f"brake.position={positions}"
    )
    return [seeded(case, seed) for case in cases for seed in conditions.seeds]
