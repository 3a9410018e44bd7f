"""The rig written a second time agrees with the rig, and a change of either is seen."""

from functools import cache

import pytest

from studies.experiments.independent_integration import BYPASSED, compared, draw
from studies.independent import integration
from studies.independent.integration import integrated
from studies.stop_runner import measured

SLOW = {"initial_speed": "8 km/h"}
EXACT = {"rig.wsp": "bypassed"}


@pytest.fixture(autouse=True, scope="module")
def _coarser():
    """A tenth of the accuracy of the study, whose errors stay below what is asserted here."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(integration, "_RELATIVE", 10.0 * integration._RELATIVE)
        patch.setattr(integration, "TOLERANCES", 10.0 * integration.TOLERANCES)
        yield


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


@pytest.fixture(scope="module")
def found(pair):
    """Compare both rigs' stops of this name, or return the comparison of before."""
    return cache(lambda name: compared(name, *pair(name)))


@pytest.mark.parametrize(
    "name", ["dry", "dry, uphill", "dry, computed force", "locked", "locked, rail cleaned"]
)
def test_both_rigs_stop_alike(found, name):
    both = found(name)
    assert abs(both.distance) < 0.1
    assert abs(both.time) < 0.1
    assert abs(both.air) < 0.05
    assert both.speed < 0.02
    assert both.force < 100.0
    assert both.residual < 5.0


@pytest.mark.parametrize(
    ("key", "value", "named"),
    [
        ("brake.command", "[{at: 0 s, value: 80 %}, {at: 1 s, value: 100 %}]", "a course of brake.command"),
        ("brake.dynamic", "{force: 100 kN, power: 2 MW}", "brake.dynamic"),
        ("brake.track", "{attraction: 100 kN}", "brake.track"),
        ("until", "5 km/h", "until"),
        ("drag", "{speed: 5 km/h, duration: 5 s}", "drag"),
        (
            "rail.variation",
            "{spread: 10 %, correlation_length: 50 m, left_right_correlation: 1}",
            "rail.variation",
        ),
    ],
)
def test_what_the_other_rig_does_not_know_is_refused(pair, key, value, named):
    case, _, recording = pair("dry", **{key: value})
    with pytest.raises(ValueError, match=f"does not know {named}$"):
        integrated(case, recording)


def test_another_pad_friction_of_one_rig_is_seen(pair):
    case, stop, recording = pair("dry")
    other, *_ = pair("dry", **{"brake.system.disc.pad_friction": 0.381})
    assert case.scenario.brake.system.disc.pad_friction == 0.38
    assert abs(compared("dry", other, stop, recording).distance) > 0.1


def test_the_wheels_of_the_locked_stop_are_locked_on_both(pair, found):
    _, stop, _ = pair("locked")
    both = found("locked")
    at_half = both.independent.times.searchsorted(0.8 * measured(stop, "braking_time_s"))
    assert both.independent.wheel_speeds[at_half].tolist() == [0.0] * 4
    assert both.wheel_speed < 0.1


def test_the_figure_is_drawn_with_its_units(found):
    figure = pytest.importorskip("matplotlib.figure").Figure()
    stop = found("dry")
    draw(stop, stop, figure)
    assert [axes.get_ylabel() for axes in figure.axes] == ["speed of the wheels, m/s"] * 2
    assert figure.axes[-1].get_xlabel() == "time, s"
