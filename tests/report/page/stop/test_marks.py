from functools import partial

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.judging.evaluation import AppliedDefinition
from uictest.report.page.stop.marks import marks_of
from uictest.report.traces.trace import trace_of

from ...builders import make_recording, make_verdict

MOVING = {"moving_speed": 10 / 3.6}
LOCKING = {**MOVING, "locked_speed": 0.1}
FILTERING = {**MOVING, "deceleration_filter": 0.5, "developed_time": 2.0}


@pytest.fixture
def record():
    """A stop at 1 m/s2 whose wheelsets slide from 5 to 15 s; the third is locked from 20 to 22 s."""
    recording = make_recording(sliding_time="5.0")
    time = recording["time"]
    recording["wheel_speed_3"][(time >= 20.0) & (time < 22.0)] = 0.0
    return recording


@pytest.fixture
def trace(record):
    """What is drawn of that stop."""
    return trace_of(record)


@pytest.fixture
def marks(record):
    """The marks of that stop, judged by one criterion."""

    return partial(marks_in, record)


def marks_in(record, measure, defined=(), **changes):
    definitions = tuple(AppliedDefinition(name, value, "", "chosen") for name, value in dict(defined).items())
    fields = {"lower": None, "upper": None, "measure": measure, "definitions": definitions}
    verdicts = [make_verdict(**(fields | changes))]
    return marks_of(verdicts, trace_of(record, verdicts))


def test_what_has_no_drawing_what_does_not_apply_and_what_is_met_has_no_marks(marks):
    assert marks("flat_length", status="fail", value=5.0, upper=1.0, unit="m") == []
    assert marks("braking_distance", lower=440.0, upper=490.0, status="not_applicable") == []
    assert marks("standstill", lower=1.0, value=1.0, unit="1") == []
    # Slower than the moving speed no wheelset is locked.
    assert marks("longest_lock", LOCKING | {"moving_speed": 30.0}, upper=1.0, unit="s") == []


def test_a_locked_wheelset_is_an_interval_in_its_row(marks):
    (mark,) = marks("longest_lock", LOCKING, status="fail", upper=1.0, value=2.0, unit="s", id="locked")
    assert (mark.plot, mark.kind, mark.y) == ("locked", "interval", 3.0)
    # From the sample before the lock to its last, as the measure counts it.
    assert (mark.x0, mark.x1) == (pytest.approx(19.99), pytest.approx(21.99))
    assert mark.label == "locked: 2 s, upper limit 1 s, above 10 km/h"


@pytest.mark.parametrize(("missed_by", "status"), [((3,), "fail"), ((1, 2), "pass"), ((), "fail")])
def test_a_wheelset_that_keeps_what_another_misses_is_not_marked_as_missing_it(marks, missed_by, status):
    own = {"status": "fail", "upper": 1.0, "value": 2.0, "unit": "s", "missed_by": missed_by}
    (mark,) = marks("longest_lock", LOCKING, **own)
    assert (mark.wheelset, mark.status) == (3, status)


def test_a_stop_that_does_not_stop_is_marked_at_the_end_of_the_record(marks, trace):
    (mark,) = marks("standstill", status="fail", lower=1.0, value=0.0, unit="1", id="standstill")
    assert (mark.plot, mark.kind, mark.x0) == ("speed", "instant", trace.end)
    assert mark.label == "standstill: the record ends at 0 km/h"


def test_the_largest_slide_of_each_wheelset_is_marked_where_it_was_too_small(marks):
    cutoff = {**MOVING, "low_speed_cutoff": 30 / 3.6}
    limit, *points = marks(
        "maximum_slide_above_cutoff", cutoff, unit="%", lower=60.0, value=40.0, status="fail"
    )
    assert limit.kind == "limit"
    # The third is locked later on.
    assert [mark.label for mark in points] == ["1: 40 %", "2: 40 %", "", "4: 40 %"]
    assert {mark.kind for mark in points} == {"point"}
    assert all(mark.x0 is not None and 5.0 < mark.x0 < 15.0 for mark in points if mark.label)


def test_vents_too_many_are_marked_from_the_first_to_the_last(marks):
    found = marks("valve_actuations", unit="1", upper=0.0, value=1.0, status="fail")
    assert [(mark.plot, mark.y) for mark in found] == [("valves", float(n)) for n in (1, 2, 3, 4)]
    assert found[0].x0 == pytest.approx(5.0, abs=0.02)
    assert found[0].x1 == pytest.approx(15.0, abs=0.02)


def test_the_smallest_deceleration_is_marked_when_it_was_so_small():
    time = np.linspace(0.0, 30.0, 3001)
    speed = 33.0 - time + np.where(time > 10.0, np.minimum(0.5 * (time - 10.0), 0.5), 0.0)
    record = Recording({"time": time, "speed": speed}, {"time": "s", "speed": "m/s"})
    bound, *_, mark = marks_in(record, "minimum_deceleration", FILTERING, unit="m/s2", lower=0.9, value=0.57)
    assert bound.y == pytest.approx(0.9 / 9.80665)  # in g
    assert (mark.kind, mark.y) == ("point", pytest.approx(0.57 / 9.80665))
    assert mark.x0 == pytest.approx(11.0, abs=0.05)


def test_failing_criteria_come_first_then_inconclusive_ones(trace):
    verdicts = [
        make_verdict(id=status, status=status, measure="braking_distance")
        for status in ("pass", "not_applicable", "inconclusive", "fail")
    ]
    drawn = dict.fromkeys(mark.criterion for mark in marks_of(verdicts, trace))
    assert list(drawn) == ["fail", "inconclusive", "pass"]


@pytest.mark.parametrize(("status", "ending"), [("fail", ""), ("inconclusive", " (inconclusive)")])
def test_the_braking_distance_is_a_band_and_a_distance_outside_an_instant_of_it_with_its_verdict(
    marks, status, ending
):
    band, reached = marks("braking_distance", lower=440.0, upper=490.0, value=510.0, status=status)
    assert (band.label, reached.label) == (f"braking-distance: 440 .. 490 m{ending}", f"510 m{ending}")
    assert (band.plot, band.kind, band.x0, band.x1, band.along) == ("speed", "band", 440.0, 490.0, "distance")
    assert (reached.kind, reached.x0) == ("instant", 510.0)
    (alone,) = marks("braking_distance", lower=440.0, upper=490.0)
    assert alone.label == "braking-distance: 440 .. 490 m"


@pytest.mark.parametrize(("margin", "label"), [(0.0, "1: 14 kN"), (-1.0, "")])
def test_a_value_at_a_bound_misses_it_where_the_bound_itself_does_not_pass(marks, margin, label):
    limits = {"upper": 14.0, "value": 14.0, "margin": margin}
    _, first, *_ = marks("maximum_clamping_force", unit="kN", **limits, status="fail")
    assert first.label == label


def test_the_first_phase_is_a_window_with_its_limit_and_what_was_found(marks):
    found = marks("initial_adhesion", {"first_phase_duration": 3.0}, unit="g", upper=0.08, value=0.06)
    shown = [(mark.plot, mark.kind, mark.x0, mark.x1, mark.y) for mark in found]
    assert shown == [
        ("speed", "window", 5.0, 8.0, None),
        ("deceleration", "window", 5.0, 8.0, None),
        ("deceleration", "limit", 5.0, 8.0, 0.08),
        ("deceleration", "mean", 5.0, 8.0, 0.06),
    ]


def test_the_slide_limit_ends_where_slides_no_longer_count(marks):
    (mark,) = marks("maximum_slide_above_cutoff", {"low_speed_cutoff": 30 / 3.6}, unit="%", lower=35.0)
    assert (mark.plot, mark.kind, mark.y, mark.x0) == ("slide", "limit", 35.0, None)
    # 120 km/h less 1 m/s2: 30 km/h after 25 s.
    assert mark.x1 == pytest.approx(25.0, abs=0.011)
