import numpy as np
import pytest

from studies.replay import maximum_pressure, replayed, replayed_in_turn


@pytest.fixture(scope="module")
def case(stop_runner):
    return stop_runner.cases("wet-80-friction", {"rail.friction": "0.10"})[0]


@pytest.fixture(scope="module")
def stop(stop_runner, case):
    return stop_runner.recordings([case])[0]


def test_its_own_commands_give_module_1_its_own_pressure(case, stop):
    again = replayed(case, stop, 1)
    pressure = np.interp(stop["time"], again["time"], again["tank_pressure_1"])
    # On the bench two modules draw from the line instead of four: it falls a little less.
    assert np.abs(pressure - stop["tank_pressure_1"]).max() < 0.02 * maximum_pressure(case)


def test_a_released_brake_clamps_no_more(case, stop):
    held, released = replayed(case, stop, 1), replayed(case, stop, 1, release=True)
    assert held["caliper_force_1"][-1] > 0.0
    assert released["caliper_force_1"][-1] == 0.0
    assert not released["wsp_acting"][-1]
    np.testing.assert_array_equal(released["stroke_1"][: len(held)], held["stroke_1"])


def test_wheelsets_are_replayed_one_after_the_other(case, stop):
    both = replayed_in_turn(case, stop, [1, 2], release=True)
    first, second = (replayed(case, stop, n, release=True) for n in (1, 2))
    assert len(both) == len(first) + len(second) - 1  # a recording begins with the state at rest
    np.testing.assert_array_equal(both["stroke_1"][: len(first)], first["stroke_1"])
