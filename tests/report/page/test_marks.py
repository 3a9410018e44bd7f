from functools import partial

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.judging.evaluation import AppliedDefinition
from uictest.report.page.marks import marks_of
from uictest.report.traces.trace import trace_of

from ..builders import make_recording, make_verdict

MOVING = {"moving_speed": 10 / 3.6}
LOCKING = {**MOVING, "locked_speed": 0.1}
FILTERING = {**MOVING, "deceleration_filter": 0.5, "developed_time": 2.0}


@pytest.fixture(scope="module")
def record():
    """A stop at 1 m/s2 whose wheelsets slide from 5 to 15 s; the third is locked from 20 to 22 s."""
    recording = make_recording(sliding_time="5.0")
    time = recording["time"]
    recording["wheel_speed_3"][(time >= 20.0) & (time < 22.0)] = 0.0
    return recording


def marks_in(record, measure, defined=(), **changes):
    """Return the marks of a stop that is judged by one criterion."""
    definitions = tuple(AppliedDefinition(name, value, "", "chosen") for name, value in dict(defined).items())
    fields = {"id": "it", "lower": None, "upper": None, "measure": measure, "definitions": definitions}
    verdicts = [make_verdict(**(fields | changes))]
    return marks_of(verdicts, trace_of(record, verdicts))


@pytest.fixture
def marks(record):
    """The marks of that stop, judged by one criterion."""
    return partial(marks_in, record)


DISTANCE = {"lower": 440.0, "upper": 490.0, "value": 510.0}
LOCK = {"status": "fail", "upper": 1.0, "value": 2.0, "unit": "s"}
CUTOFF = {**MOVING, "low_speed_cutoff": 30 / 3.6}


@pytest.mark.parametrize(
    ("measure", "defined", "changes", "expected"),
    [
        # What has no drawing, what does not apply and what is met has no marks.
        ("flat_length", {}, {"status": "fail", "value": 5.0, "upper": 1.0, "unit": "m"}, []),
        ("braking_distance", {}, {**DISTANCE, "status": "not_applicable"}, []),
        ("standstill", {}, {"lower": 1.0, "value": 1.0, "unit": "1"}, []),
        # Slower than the moving speed no wheelset is locked.
        ("longest_lock", LOCKING | {"moving_speed": 30.0}, {"upper": 1.0, "unit": "s"}, []),
        # It is not defined how long the first phase lasts.
        ("initial_adhesion", {}, {"unit": "g", "upper": 0.08, "value": 0.06}, []),
        # A lock lasts from the sample before it to its last, as the measure counts it.
        (
            *("longest_lock", LOCKING, LOCK),
            [("locked", "interval", 19.99, 21.99, 3.0, "it: 2 s, upper limit 1 s, above 10 km/h")],
        ),
        # A stop that does not stop is marked at the end of the record.
        (
            *("standstill", {}, {"status": "fail", "lower": 1.0, "value": 0.0, "unit": "1"}),
            [("speed", "instant", 34.0, 34.0, None, "it: the record ends at 0 km/h")],
        ),
        # A distance is a band, and one outside an instant of it with its verdict.
        ("braking_distance", {}, DISTANCE, [("speed", "band", 440.0, 490.0, None, "it: 440 .. 490 m")]),
        *(
            (
                *("braking_distance", {}, {**DISTANCE, "status": status}),
                [
                    ("speed", "band", 440.0, 490.0, None, f"it: 440 .. 490 m{ending}"),
                    ("speed", "instant", 510.0, 510.0, None, f"510 m{ending}"),
                ],
            )
            for status, ending in (("fail", ""), ("inconclusive", " (inconclusive)"))
        ),
        # The first phase is a window with its limit and what was found.
        (
            *("initial_adhesion", {"first_phase_duration": 3.0}, {"unit": "g", "upper": 0.08, "value": 0.06}),
            [
                ("speed", "window", 5.0, 8.0, None, "first phase, 3 s"),
                ("deceleration", "window", 5.0, 8.0, None, ""),
                ("deceleration", "limit", 5.0, 8.0, 0.08, "limit 0.08 g"),
                ("deceleration", "mean", 5.0, 8.0, 0.06, "mean 0.06 g"),
            ],
        ),
        # The limit ends where slides no longer count: 120 km/h less 1 m/s2 is 30 km/h after 25 s.
        (
            *("maximum_slide_above_cutoff", {"low_speed_cutoff": 30 / 3.6}, {"unit": "%", "upper": 35.0}),
            [("slide", "limit", None, 25.0, 35.0, "limit 35 %")],
        ),
    ],
)
def test_a_criterion_is_marked_where_it_was_decided(marks, measure, defined, changes, expected):
    found = marks(measure, defined, **changes)
    assert [(mark.plot, mark.kind, mark.label) for mark in found] == [
        (plot, kind, label) for plot, kind, *_, label in expected
    ]
    for mark, (_, kind, *places, _) in zip(found, expected, strict=True):
        assert (mark.x0, mark.x1, mark.y) == pytest.approx(tuple(places), abs=0.011)
        along = "distance" if measure == "braking_distance" else "time"
        assert mark.along == along, kind


@pytest.mark.parametrize(("missed_by", "status"), [((3,), "fail"), ((1, 2), "pass"), ((), "fail")])
def test_a_wheelset_that_keeps_what_another_misses_is_not_marked_as_missing_it(marks, missed_by, status):
    (mark,) = marks("longest_lock", LOCKING, **LOCK, missed_by=missed_by)
    assert (mark.wheelset, mark.status) == (3, status)


def test_the_largest_slide_of_each_wheelset_is_marked_where_it_was_too_small(marks):
    limit, *points = marks(
        "maximum_slide_above_cutoff", CUTOFF, unit="%", lower=60.0, value=40.0, status="fail"
    )
    assert limit.kind == "limit"
    # The third is locked later on.
    assert [mark.label for mark in points] == ["1: 40 %", "2: 40 %", "", "4: 40 %"]
    assert {mark.kind for mark in points} == {"point"}
    assert all(mark.x0 is not None and 5.0 < mark.x0 < 15.0 for mark in points if mark.label)


def test_vents_too_many_are_marked_from_the_first_to_the_last(marks):
    found = marks("valve_actuations", unit="1", upper=0.0, value=1.0, status="fail")
    assert [(mark.plot, mark.y) for mark in found] == [("valves", float(n)) for n in (1, 2, 3, 4)]
    assert (found[0].x0, found[0].x1) == pytest.approx((5.0, 15.0), abs=0.02)


def test_the_smallest_deceleration_is_marked_when_it_was_so_small():
    time = np.linspace(0.0, 30.0, 3001)
    speed = 33.0 - time + np.where(time > 10.0, np.minimum(0.5 * (time - 10.0), 0.5), 0.0)
    record = Recording({"time": time, "speed": speed}, {"time": "s", "speed": "m/s"})
    bound, *_, mark = marks_in(record, "minimum_deceleration", FILTERING, unit="m/s2", lower=0.9, value=0.57)
    assert (bound.y, mark.y) == pytest.approx((0.9 / 9.80665, 0.57 / 9.80665))  # in g
    assert mark.kind == "point"
    assert mark.x0 == pytest.approx(11.0, abs=0.05)


def test_failing_criteria_come_first_then_inconclusive_ones(record):
    verdicts = [
        make_verdict(id=status, status=status, measure="braking_distance")
        for status in ("pass", "not_applicable", "inconclusive", "fail")
    ]
    drawn = dict.fromkeys(mark.criterion for mark in marks_of(verdicts, trace_of(record)))
    assert list(drawn) == ["fail", "inconclusive", "pass"]


@pytest.mark.parametrize(("margin", "label"), [(0.0, "1: 14 kN"), (-1.0, "")])
def test_a_value_at_a_bound_misses_it_where_the_bound_itself_does_not_pass(marks, margin, label):
    limits = {"upper": 14.0, "value": 14.0, "margin": margin}
    _, first, *_ = marks("maximum_clamping_force", unit="kN", **limits, status="fail")
    assert first.label == label
