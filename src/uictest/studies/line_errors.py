"""What four lines of force against pressure gain over two, along stops that trained neither."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from uictest.core.recording import Recording
from uictest.core.units import PERCENT
from uictest.plans.scenario import Case
from uictest.studies.judged_conditions import JudgedConditions, judged_cases
from uictest.studies.replay import CYCLE, replayed
from uictest.studies.stop_runner import StopRunner


@dataclass(frozen=True, slots=True)
class LineErrors:
    """Errors of the force that lines compute from the pressure of module 1, % of the largest force."""

    largest: float
    rms: float


def held_out_errors(stop_runner: StopRunner, conditions: JudgedConditions) -> dict[str, list[LineErrors]]:
    """Return the errors of the compensation's `four` lines, and of its `two` BC lines, along judged stops.

    Every wheelset of the conditions is replayed, under the first of their seeds.
    """
    cases = judged_cases(stop_runner, conditions.model_copy(update={"seeds": conditions.seeds[:1]}))
    stops = stop_runner.recordings(cases, CYCLE)
    work = [(case, stop, n) for case, stop in zip(cases, stops, strict=True) for n in conditions.wheelsets]
    return {
        "four": stop_runner.map(lambda each: _errors(*each), work),
        "two": stop_runner.map(lambda each: _errors(with_bc_lines(each[0]), *each[1:]), work),
    }


def with_bc_lines(case: Case) -> Case:
    """Return a case whose compensation has the lines of the BC in the phases of the WSP as well."""
    rig = case.scenario.rig
    model, lines = rig.compensation_model, rig.compensation_model.hysteresis
    two = {"wsp_squeezing": lines.bc_squeezing, "wsp_releasing": lines.bc_releasing}
    changed = model.model_copy(update={"hysteresis": lines.model_copy(update=two)})
    changed_rig = rig.model_copy(update={"compensation_model": changed})
    return replace(case, scenario=case.scenario.model_copy(update={"rig": changed_rig}))


def _errors(case: Case, stop: Recording, wheelset: int) -> LineErrors:
    recording = replayed(case, stop, wheelset)
    measured = recording["clamping_force_1"]
    error = (recording["computed_force_1"] - measured) / measured.max() / PERCENT
    return LineErrors(float(np.abs(error).max()), float(np.sqrt(np.mean(error**2))))
