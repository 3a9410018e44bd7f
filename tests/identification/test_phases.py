"""Phases of a record."""

import numpy as np

from uictest.rig.identification.lines import (
    on_lines,
    runs,
    wsp_acting_from_commands,
    wsp_acting_in_intervals,
)

from .conftest import LINES, STEP


def test_runs_end_at_the_extremes():
    pressure = np.array([0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 2.0, 3.0, 4.0])
    assert runs(pressure, 0.5) == [(0, 3, 1), (3, 5, -1), (5, 8, 1)]


def test_a_ripple_smaller_than_the_threshold_does_not_turn_the_pressure():
    pressure = np.array([0.0, 1.0, 0.8, 2.0, 1.9, 3.0])
    assert runs(pressure, 0.5) == [(0, 5, 1)]


def test_a_constant_pressure_has_no_run():
    assert runs(np.ones(5), 0.1) == []


def test_every_point_that_counts_lies_on_its_line(pressures, force):
    _, pressure, acting = pressures
    squeezing, releasing = on_lines(pressure, force, STEP)
    assert np.count_nonzero(squeezing) > 1000
    assert np.count_nonzero(releasing) > 1000
    for mask, name in ((squeezing, "squeezing"), (releasing, "releasing")):
        for kind, phase in (("bc", ~acting), ("wsp", acting)):
            points = mask & phase
            line = LINES[f"{kind}_{name}"].force(pressure[points])
            far = np.abs(force[points] - line) > 0.002 * force.max()
            assert np.mean(far) < 0.02


def test_the_wsp_acts_for_a_while_after_its_last_command():
    time = np.arange(7.0)
    commands = np.array([0.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0])
    acting = wsp_acting_from_commands(time, commands, 2.0)
    assert acting.tolist() == [False, False, True, True, True, False, False]


def test_the_wsp_acts_in_given_intervals():
    acting = wsp_acting_in_intervals(np.arange(6.0), [(1.0, 2.0), (4.0, 9.0)])
    assert acting.tolist() == [False, True, True, False, True, True]
