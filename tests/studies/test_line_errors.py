from __future__ import annotations

from studies.judged_conditions import JudgedConditions
from studies.phases import held_out_errors, with_bc_lines
from studies.stop_runner import StopRunner


def test_two_lines_are_those_of_the_bc() -> None:
    case = StopRunner().cases("slide-80")[0]
    lines = case.scenario.rig.compensation_model.hysteresis
    changed = with_bc_lines(case).scenario.rig.compensation_model.hysteresis
    assert (changed.wsp_squeezing, changed.wsp_releasing) == (lines.bc_squeezing, lines.bc_releasing)
    assert (changed.bc_squeezing, changed.bc_releasing) == (lines.bc_squeezing, lines.bc_releasing)
    assert changed.transition_time == lines.transition_time


def test_four_lines_and_two_differ_only_where_the_wsp_acts(stop_runner: StopRunner) -> None:
    slippery, good = 0.11, 0.3
    conditions = JudgedConditions(
        frictions=(slippery, good), positions=("R",), wheelsets=(1,), seeds=(31, 32)
    )
    errors = held_out_errors(stop_runner, conditions)
    assert len(errors["four"]) == len(errors["two"]) == 2
    assert errors["four"][0] != errors["two"][0]
    assert errors["four"][1] == errors["two"][1]
