"""Brake applications in a record."""

import numpy as np
import pytest

from uictest.rig.identification.record import applications

STEP = 0.01


def ramps(*corners):
    times, levels = np.array(corners, dtype=float).T
    return np.interp(np.arange(round(times[-1] / STEP)) * STEP, times, levels)


def test_each_begins_at_rest_and_ends_before_its_release():
    tank = ramps((0, 0), (1, 0), (2, 3e5), (5, 3e5), (6, 0), (8, 0), (9, 2e5), (11, 2e5), (12, 0), (14, 0))
    first, second = applications(tank, tank, STEP)
    assert first.start * STEP == pytest.approx(1.0, abs=0.1)
    assert 1.9 < first.stop * STEP < 5.1
    assert second.start * STEP == pytest.approx(8.0, abs=0.1)
    assert 8.9 < second.stop * STEP < 11.1


def test_a_short_release_between_two_cycles_does_not_divide_a_stop():
    tank = ramps((0, 0), (1, 3e5), (2, 0), (2.2, 0), (3, 3e5), (5, 3e5))
    assert len(applications(tank, tank, STEP)) == 1


def test_a_record_that_never_rests_is_one_stretch():
    tank = ramps((0, 2e5), (5, 3e5))
    assert applications(tank, tank, STEP) == [slice(0, len(tank))]
