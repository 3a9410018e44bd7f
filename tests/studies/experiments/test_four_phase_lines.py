import math
from types import SimpleNamespace

import pytest

from studies.experiments.four_phase_lines import LineErrors, _gain, apart, held_out_errors, with_bc_lines
from studies.model_errors import JudgedConditions
from studies.stop_runner import StopRunner
from uictest.rig.identification.lines import FittedLine


def hysteresis(**lines):
    """A result of which only some lines are known."""
    return SimpleNamespace(lines=lines)


BC = FittedLine(0.042, -1900.0, slope_confidence=3e-5, intercept_confidence=30.0)


@pytest.mark.parametrize(
    ("slope", "intercept", "ratio"), [(0.0421, -1900.0, 2.0), (0.042, -1750.0, 3.0), (0.0419, -2050.0, 3.0)]
)
def test_lines_are_apart_by_slope_or_intercept(slope, intercept, ratio):
    wsp = FittedLine(slope, intercept, slope_confidence=4e-5, intercept_confidence=40.0)
    assert apart(hysteresis(bc_squeezing=BC, wsp_squeezing=wsp), "squeezing") == pytest.approx(ratio)
    assert math.isnan(apart(hysteresis(bc_squeezing=BC), "squeezing"))


def test_the_note_counts_where_four_lines_are_nearer():
    two = [LineErrors(2.0, 0.5)] * 3
    four = [LineErrors(1.0, 0.6), LineErrors(3.0, 0.4), LineErrors(1.5, 0.5)]
    note = _gain({"four": four, "two": two})
    assert "along 3 replays" in note
    assert "in 2 of them by the largest error, in 1 by the rms error" in note


def test_two_lines_are_those_of_the_bc():
    case = StopRunner().cases("slide-80")[0]
    lines = case.scenario.rig.compensation_model.hysteresis
    changed = with_bc_lines(case).scenario.rig.compensation_model.hysteresis
    assert (changed.wsp_squeezing, changed.wsp_releasing) == (lines.bc_squeezing, lines.bc_releasing)
    assert (changed.bc_squeezing, changed.bc_releasing) == (lines.bc_squeezing, lines.bc_releasing)
    assert changed.transition_time == lines.transition_time


def test_four_lines_and_two_differ_only_where_the_wsp_acts(stop_runner):
    slippery, good = 0.11, 0.3
    conditions = JudgedConditions((slippery, good), ("R",), wheelsets=(1,), seeds=(31, 32))
    errors = held_out_errors(stop_runner, conditions)
    assert len(errors["four"]) == len(errors["two"]) == 2
    assert errors["four"][0] != errors["two"][0]
    assert errors["four"][1] == errors["two"][1]
