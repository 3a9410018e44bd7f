from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.judging.evaluation import AppliedDefinition
from uictest.report.page.stop.mark import Mark
from uictest.report.page.stop.marks import marks_of
from uictest.report.traces.trace import PlotTrace, trace_of

from ...builders import make_recording, make_verdict

Marks = Callable[..., list[Mark]]

MOVING = {"moving_speed": 10 / 3.6}
LOCKING = {**MOVING, "locked_speed": 0.1}
FILTERING = {**MOVING, "deceleration_filter": 0.5, "developed_time": 2.0}


@pytest.fixture
def record() -> Recording:
    """A stop at 1 m/s2 whose wheelsets slide from 5 to 15 s; the third is locked from 20 to 22 s."""
    recording = make_recording(sliding_time="5.0")
    time = recording["time"]
    recording["wheel_speed_3"][(time >= 20.0) & (time < 22.0)] = 0.0
    return recording


@pytest.fixture
def trace(record: Recording) -> PlotTrace:
    """What is drawn of that stop."""
    return trace_of(record)


@pytest.fixture
def marks(record: Recording) -> Marks:
    """The marks of that stop, judged by one criterion."""

    def make(measure: str, defined: Mapping[str, float] | None = None, **changes: object) -> list[Mark]:
        definitions = tuple(
            AppliedDefinition(name, value, "", "chosen") for name, value in (defined or {}).items()
        )
        fields = {"lower": None, "upper": None, "measure": measure, "definitions": definitions}
        verdicts = [make_verdict(**(fields | changes))]
        return marks_of(verdicts, trace_of(record, verdicts))

    return make


def test_a_measure_without_a_drawing_has_no_marks(marks: Marks) -> None:
    assert marks("flat_length", status="fail", value=5.0, upper=1.0, unit="m") == []


def test_a_locked_wheelset_is_an_interval_in_its_row(marks: Marks) -> None:
    (mark,) = marks("longest_lock", LOCKING, status="fail", upper=1.0, value=2.0, unit="s", id="locked")
    assert (mark.plot, mark.kind, mark.y) == ("locked", "interval", 3.0)
    # From the sample before the lock to its last, as the measure counts it.
    assert (mark.x0, mark.x1) == (pytest.approx(19.99), pytest.approx(21.99))
    assert mark.label == "locked: 2 s, upper limit 1 s"


def test_a_lock_below_the_moving_speed_is_none(marks: Marks) -> None:
    assert marks("longest_lock", {**LOCKING, "moving_speed": 30.0}, upper=1.0, unit="s") == []


def test_a_stop_that_does_not_stop_is_marked_at_the_end_of_the_record(marks: Marks, trace: PlotTrace) -> None:
    (mark,) = marks("standstill", status="fail", lower=1.0, value=0.0, unit="1", id="standstill")
    assert (mark.plot, mark.kind, mark.x0) == ("speed", "instant", trace.end)
    assert mark.label == "standstill: the record ends at 0 km/h"
    assert marks("standstill", lower=1.0, value=1.0, unit="1") == []


def test_the_largest_slide_of_each_wheelset_is_marked_where_it_was_too_small(marks: Marks) -> None:
    cutoff = {**MOVING, "low_speed_cutoff": 30 / 3.6}
    limit, *points = marks(
        "maximum_slide_above_cutoff", cutoff, unit="%", lower=60.0, value=40.0, status="fail"
    )
    assert limit.kind == "limit"
    assert [(mark.kind, mark.label) for mark in points] == [
        ("point", "1: 40 %"),
        ("point", "2: 40 %"),
        ("point", ""),  # locked later on
        ("point", "4: 40 %"),
    ]
    assert all(mark.x0 is not None and 5.0 < mark.x0 < 15.0 for mark in points if mark.label)


def test_vents_too_many_are_marked_from_the_first_to_the_last(marks: Marks) -> None:
    found = marks("valve_actuations", unit="1", upper=0.0, value=1.0, status="fail")
    assert [(mark.plot, mark.y) for mark in found] == [
        ("valves", 1.0),
        ("valves", 2.0),
        ("valves", 3.0),
        ("valves", 4.0),
    ]
    assert found[0].x0 == pytest.approx(5.0, abs=0.02)
    assert found[0].x1 == pytest.approx(15.0, abs=0.02)


def test_the_smallest_deceleration_is_marked_when_it_was_so_small() -> None:
    time = np.linspace(0.0, 30.0, 3001)
    speed = 33.0 - time + np.where(time > 10.0, np.minimum(0.5 * (time - 10.0), 0.5), 0.0)
    definitions = tuple(AppliedDefinition(name, value, "", "chosen") for name, value in FILTERING.items())
    verdict = make_verdict(
        measure="minimum_deceleration",
        unit="m/s2",
        lower=0.9,
        upper=None,
        value=0.57,
        definitions=definitions,
    )
    record = Recording({"time": time, "speed": speed}, {"time": "s", "speed": "m/s"})
    *_, mark = marks_of([verdict], trace_of(record, [verdict]))
    assert (mark.kind, mark.y) == ("point", pytest.approx(0.57 / 9.80665))
    assert mark.x0 == pytest.approx(11.0, abs=0.05)


def test_failing_criteria_come_first_then_inconclusive_ones(trace: PlotTrace) -> None:
    verdicts = [
        make_verdict(id=status, status=status, measure="braking_distance")
        for status in ("pass", "not_applicable", "inconclusive", "fail")
    ]
    drawn = dict.fromkeys(mark.criterion for mark in marks_of(verdicts, trace))
    assert list(drawn) == ["fail", "inconclusive", "pass"]


@pytest.mark.parametrize(("status", "ending"), [("fail", ""), ("inconclusive", " (inconclusive)")])
def test_a_mark_says_in_words_that_a_criterion_was_not_decided(
    marks: Marks, status: str, ending: str
) -> None:
    band, reached = marks("braking_distance", lower=440.0, upper=490.0, value=510.0, status=status)
    assert (band.label, reached.label) == (f"braking-distance: 440 .. 490 m{ending}", f"510 m{ending}")


@pytest.mark.parametrize(("margin", "label"), [(0.0, "1: 14 kN"), (-1.0, "")])
def test_a_value_at_a_bound_misses_it_where_the_bound_itself_does_not_pass(
    marks: Marks, margin: float, label: str
) -> None:
    limits = {"upper": 14.0, "value": 14.0, "margin": margin}
    _, first, *_ = marks("maximum_clamping_force", unit="kN", **limits, status="fail")
    assert first.label == label


def test_the_first_phase_is_a_window_with_its_limit_and_what_was_found(marks: Marks) -> None:
    found = marks("initial_adhesion", {"first_phase_duration": 3.0}, unit="g", upper=0.08, value=0.06)
    shown = [(mark.plot, mark.kind, mark.x0, mark.x1, mark.y) for mark in found]
    assert shown == [
        ("speed", "window", 5.0, 8.0, None),
        ("deceleration", "window", 5.0, 8.0, None),
        ("deceleration", "limit", 5.0, 8.0, 0.08),
        ("deceleration", "mean", 5.0, 8.0, 0.06),
    ]


def test_the_slide_limit_ends_where_slides_no_longer_count(marks: Marks) -> None:
    (mark,) = marks("maximum_slide_above_cutoff", {"low_speed_cutoff": 30 / 3.6}, unit="%", lower=35.0)
    assert (mark.plot, mark.kind, mark.y, mark.x0) == ("slide", "limit", 35.0, None)
    # 120 km/h less 1 m/s2: 30 km/h after 25 s.
    assert mark.x1 == pytest.approx(25.0, abs=0.011)


def test_the_braking_distance_is_a_band_over_the_distance(marks: Marks) -> None:
    (mark,) = marks("braking_distance", lower=440.0, upper=490.0)
    assert (mark.plot, mark.kind, mark.x0, mark.x1) == ("over-distance", "band", 440.0, 490.0)
    assert mark.label == "braking-distance: 440 .. 490 m"


def test_a_distance_outside_its_band_is_marked_in_it(marks: Marks) -> None:
    _, reached = marks("braking_distance", lower=440.0, upper=490.0, value=510.0, status="fail")
    assert (reached.kind, reached.x0, reached.label) == ("instant", 510.0, "510 m")


def test_a_deceleration_bound_is_drawn_in_g(marks: Marks) -> None:
    mark, *_ = marks("minimum_deceleration", unit="m/s2", lower=0.5 * 9.80665)
    assert mark.y == pytest.approx(0.5)


def test_a_criterion_that_does_not_apply_is_not_drawn(marks: Marks) -> None:
    assert marks("braking_distance", lower=440.0, upper=490.0, status="not_applicable") == []
