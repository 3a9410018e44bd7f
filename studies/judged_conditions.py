"""Conditions of the stops that the compensation is judged on; neither training nor calibration uses them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import yaml
from pydantic import BaseModel, ConfigDict, Field

from studies.stop_runner import StopRunner, seeded
from uictest import Case

_FILE = Path(__file__).parent / "conditions" / "judgement.yaml"


class JudgedConditions(BaseModel):
    """Every combination of a friction, a position, a wheelset and a seed is judged."""

    model_config = ConfigDict(frozen=True, extra="forbid")

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
    return JudgedConditions.model_validate(yaml.safe_load(_FILE.read_text("utf-8")))


def judged_cases(stop_runner: StopRunner, conditions: JudgedConditions) -> list[Case]:
    """Return the slide test at every friction and in every position, under every seed.

    Every module has a caliper, so that the valve commands do not depend on a compensation.
    """
    varied = {"rail.friction": conditions.frictions, "brake.position": conditions.positions}
    cases = stop_runner.cases("slide-80-four-caliper", varied)
    return [seeded(case, seed) for case in cases for seed in conditions.seeds]
