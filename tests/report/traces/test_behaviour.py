"""What a recording shows of a WSP: facts that follow from how its channels were made."""

import math

import numpy as np
import pytest

from uictest.report.behaviour_sentences import behaviour_causes, behaviour_facts
from uictest.report.traces.behaviour import wsp_behaviour

TIME = np.linspace(0.0, 30.0, 3001)
SPEED = 30.0 - 0.8 * TIME


def channels(slide=0.0, vent=False, reference=None, force=None):
    """A stop from 108 km/h whose wheelset 1 slides and is vented as given; the others roll."""
    content = {"time": TIME, "speed": SPEED}
    for n in (1, 2, 3, 4):
        content[f"wheel_speed_{n}"] = SPEED * (1.0 - (slide if n == 1 else 0.0))
        content[f"valve_command_{n}"] = np.where(vent, 2.0, 0.0) * (n == 1) * np.ones_like(TIME)
        content[f"clamping_force_{n}"] = np.full_like(TIME, 1e4) if force is None or n != 1 else force
    return content if reference is None else content | {"reference_speed": reference}


def between(first, last):
    return (first <= TIME) & (last > TIME)


@pytest.mark.parametrize(
    ("sliding", "vent", "unvented"),
    [
        pytest.param(between(3.0, 8.0), between(4.5, 5.5), (3.0, 1.5), id="late"),
        pytest.param(between(3.0, 8.0), between(2.0, 3.5), None, id="vented-already"),
        pytest.param(between(3.0, 8.0), between(2.0, 2.9), None, id="vented-shortly-before"),
        pytest.param(between(3.0, 8.0), between(1.0, 2.0), (3.0, 5.0), id="vented-long-before"),
        pytest.param(between(3.0, 8.0), False, (3.0, 5.0), id="never"),
        pytest.param(between(3.0, 3.05), between(20.0, 21.0), (3.0, 0.05), id="a-blip"),
        pytest.param(
            between(3.0, 4.0) | between(9.0, 14.0),
            between(3.1, 4.0) | between(11.0, 14.0),
            (9.0, 2.0),
            id="a-later-slide-waits-longer",
        ),
    ],
)
def test_longest_slide_that_no_vent_answers(sliding, vent, unvented):
    behaviour = wsp_behaviour(channels(np.where(sliding, 0.4, 0.0), vent))
    found = behaviour.unvented
    assert (found and found[1:]) == (unvented and pytest.approx(unvented, abs=0.011))
    assert len(list(behaviour_causes(behaviour))) == bool(unvented and unvented[1] > 1.0)


def test_who_never_slides_is_never_late():
    behaviour = wsp_behaviour(channels(0.2))
    assert (behaviour.unvented, behaviour.deep_slide) == (None, None)
    assert list(behaviour_causes(behaviour)) == []


def test_reference_speed_where_it_is_furthest_from_the_train_as_a_share():
    reference = SPEED * np.where(between(10.0, 12.0), 0.5, 0.95)
    error = wsp_behaviour(channels(reference=reference)).reference
    assert (error.share, error.time, error.start) == (pytest.approx(-0.5), pytest.approx(10.0), 10.0)
    [cause] = behaviour_causes(wsp_behaviour(channels(reference=reference)))
    assert "wrong by more than 15 % from 10 s on" in cause
    assert "39.6 km/h while the train runs at 79.2 km/h (10 s)" in cause


@pytest.mark.parametrize("earlier", [pytest.param(False, id="once"), pytest.param(between(2, 3), id="again")])
def test_a_reference_speed_is_wrong_since_its_last_right_value_however_much_the_error_grows(earlier):
    reference = SPEED * np.where((TIME < 8.0) & ~np.asarray(earlier), 1.0, np.where(TIME < 12.0, 0.8, 0.3))
    error = wsp_behaviour(channels(reference=reference)).reference
    assert error.start == pytest.approx(8.0, abs=0.011)
    assert error.time >= 12.0


@pytest.mark.parametrize("reference", [None, np.full_like(TIME, math.nan)])
def test_a_controller_without_reference_speed_has_no_error_of_it(reference):
    assert wsp_behaviour(channels(reference=reference)).reference is None


def test_longest_time_without_brake_begins_only_once_the_brake_was_applied():
    force = np.where(between(0.0, 2.0) | between(6.0, 11.0) | between(13.0, 14.0), 100.0, 1e4)
    released = wsp_behaviour(channels(force=force)).released
    assert (released.start, released.duration) == (pytest.approx(6.0), pytest.approx(5.0))


def test_deep_slides_and_vents_of_rolling_wheelsets_are_told():
    slide = np.where(between(5.0, 7.0), 0.8, np.where(between(9.0, 12.0), 0.6, 0.0))
    vent = between(1.0, 1.2) | between(2.0, 2.2) | between(5.1, 6.0)
    behaviour = wsp_behaviour(channels(slide, vent))
    assert behaviour.deep_slide.duration == pytest.approx(3.0)
    assert behaviour.rolling_vents == 2
    facts = behaviour_facts(behaviour)
    assert facts["longest slide above 50 %"] == "3 s from 9 s, wheelset 1"
    assert facts["vents while rolling"] == "2"


def test_below_ten_kilometres_an_hour_nothing_counts():
    speed = np.where(TIME < 10.0, 30.0, 2.0)
    locked = {f"wheel_speed_{n}": np.where(TIME < 10.0, 30.0, 0.0) for n in (1, 2, 3, 4)}
    content = channels() | {"speed": speed} | locked
    behaviour = wsp_behaviour(content)
    assert (behaviour.unvented, behaviour.deep_slide) == (None, None)


def test_a_recording_without_speed_tells_nothing():
    assert wsp_behaviour({"time": TIME}) == (None, None, None, None, None)
