"""Ways from the pressure of tank 2 to that of cylinder 1, judged on stops that none of them was fitted to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from studies.model_errors import judged_cases, judged_conditions, pressure_error
from studies.replay import maximum_pressure, replayed
from studies.stop_runner import StopRunner, constant_friction
from studies.study import Table
from uictest import Case, Recording
from uictest.rig import identification
from uictest.units import PERCENT

PROCEDURES = {
    "nothing": "tank 2 as it is",
    "own_stop": "free filter fitted to the stop that is shown",
    "free": "free filter fitted to the training of full",
    "full": "filter of full, which ships",
    "thermal": "modelled air of thermal, which ships",
}
"""Ways to the pressure of cylinder 1."""


@dataclass(frozen=True, slots=True)
class HeldOutErrors:
    """The largest error of each procedure along the commands of one wheelset in the stop of a case."""

    case: Case
    wheelset: int
    errors: Mapping[str, float]


def procedure_errors(
    recording: Recording, top: float, filters: Mapping[str, identification.TransferFunction]
) -> dict[str, float]:
    """Return the largest error of each of :data:`PROCEDURES` over a bench recording, % of `top` Pa."""
    return {
        "nothing": pressure_error(recording, "none", top),
        **{name: filter_error(recording, each, top) for name, each in filters.items()},
        **{setting: pressure_error(recording, setting, top) for setting in ("full", "thermal")},
    }


def held_out_errors(
    stop_runner: StopRunner, filters: Mapping[str, identification.TransferFunction]
) -> list[HeldOutErrors]:
    """Replay the commands of every judged stop and wheelset."""
    conditions = judged_conditions()
    cases = judged_cases(stop_runner, conditions)
    stops = zip(cases, stop_runner.recordings(cases), strict=True)
    work = [(case, stop, n) for case, stop in stops for n in conditions.wheelsets]

    def errors(arguments: tuple[Case, Recording, int]) -> HeldOutErrors:
        case, _, wheelset = arguments
        found = procedure_errors(replayed(*arguments), maximum_pressure(case), filters)
        return HeldOutErrors(case, wheelset, found)

    return stop_runner.map(errors, work)


def worst_note(held_out: Sequence[HeldOutErrors], name: str) -> str:
    """Return where a procedure errs most."""
    worst = max(held_out, key=lambda each: each.errors[name])
    return (
        f"Worst of {PROCEDURES[name]}: {worst.errors[name]:.1f} % at friction"
        f" {constant_friction(worst.case):g}, position {worst.case.scenario.brake.position}, wheelset"
        f" {worst.wheelset}."
    )


def held_out_table(held_out: Sequence[HeldOutErrors]) -> Table:
    """Return the errors of all procedures, a row for each replay."""
    scenarios = [each.case.scenario for each in held_out]
    return {
        "friction": [constant_friction(each.case) for each in held_out],
        "position": [scenario.brake.position for scenario in scenarios],
        "wheelset": [each.wheelset for each in held_out],
        "seed": [scenario.seed for scenario in scenarios],
        **{f"{name}_percent": [each.errors[name] for each in held_out] for name in PROCEDURES},
    }


def fitted_filter(recording: Recording) -> identification.TransferFunction:
    """Return the free filter from the reading of tank 2 to that of cylinder 1 over a bench recording."""
    return identification.fitted_freely(
        recording["time"], recording["measured_pressure_2"], recording["cylinder_pressure_1"]
    )


def filter_error(recording: Recording, filtering: identification.TransferFunction, top: float) -> float:
    """Return the largest difference of a filtered tank pressure from that of cylinder 1, % of `top` Pa."""
    difference = filtering.output(recording["measured_pressure_2"]) - recording["cylinder_pressure_1"]
    return float(np.abs(difference).max()) / top / PERCENT
