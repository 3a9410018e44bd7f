"""The rig written a second time agrees with the rig, and a change of either is seen."""

import pytest

from studies.experiments.independent_integration import BYPASSED, compared, draw
from studies.stop_runner import measured

SLOW = {"initial_speed": "12 km/h"}
EXACT = {"rig.wsp": "bypassed"}


@pytest.fixture(scope="module")
def pair(stop_runner):
    """Return a stop of the study, from walking pace, on both rigs."""
    from studies.experiments import independent_integration as study

    def make(name, **changes):
        scenario, own = BYPASSED[name]
        (case,) = stop_runner.cases(scenario, {**study._EXACT, **own, **SLOW, **EXACT, **changes})
        (judged,) = stop_runner.repeated([case], [0])
        (recording,) = stop_runner.recordings([case])
        return case, judged.stops[0], recording

    return make


@pytest.mark.parametrize(
    "name", ["dry", "dry, uphill", "dry, computed force", "locked", "locked, rail cleaned"]
)
def test_both_rigs_stop_alike(pair, name):
    found = compared(name, *pair(name))
    assert abs(found.distance) < 0.1
    assert abs(found.time) < 0.1
    assert abs(found.air) < 0.05
    assert found.speed < 0.02
    assert found.force < 100.0
    assert found.residual < 5.0


def test_another_pad_friction_of_one_rig_is_seen(pair):
    case, stop, recording = pair("dry")
    other, *_ = pair("dry", **{"brake.system.disc.pad_friction": 0.381})
    assert case.scenario.brake.system.disc.pad_friction == 0.38
    assert abs(compared("dry", other, stop, recording).distance) > 0.1


def test_the_wheels_of_the_locked_stop_are_locked_on_both(pair):
    case, stop, recording = pair("locked")
    found = compared("locked", case, stop, recording)
    at_half = found.independent.times.searchsorted(0.8 * measured(stop, "braking_time_s"))
    assert found.independent.wheel_speeds[at_half].tolist() == [0.0] * 4
    assert found.wheel_speed < 0.1


def test_the_figure_is_drawn_with_its_units(pair):
    figure = pytest.importorskip("matplotlib.figure").Figure()
    stop = compared("dry", *pair("dry"))
    draw(stop, stop, figure)
    assert [axes.get_ylabel() for axes in figure.axes] == ["speed of the wheels, m/s"] * 2
    assert figure.axes[-1].get_xlabel() == "time, s"
