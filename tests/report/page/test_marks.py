"""Where a criterion is marked in the plots, when its value was taken, and what it has to spare."""

from functools import partial

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.judging.evaluation import (
    AppliedDefinition,
    CaseResult,
    Sensitivity,
    VerdictInterval,
    narrowest_margin,
)
from uictest.plans.scenario import PASS
from uictest.report.case_lines import turns_text
from uictest.report.page.margins import margin_share, margins_of
from uictest.report.page.marks import marks_of
from uictest.report.traces.instants import taken_at
from uictest.report.traces.trace import PlotTrace, trace_of

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


ADHESION = {"unit": "g", "upper": 0.08, "value": 0.06}


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
        ("initial_adhesion", {}, ADHESION, []),
        # A lock lasts from the sample before it to its last, as the measure counts it.
        ("longest_lock", LOCKING, LOCK,
         [("locked", "interval", 19.99, 21.99, 3.0, "it: 2 s (limit 1 s), above 10 km/h")]),
        # A stop that does not stop is marked at the end of the record.
        ("standstill", {}, {"status": "fail", "lower": 1.0, "value": 0.0, "unit": "1"},
         [("speed", "instant", 34.0, 34.0, None, "it: the record ends at 0 km/h")]),
        # A distance is a band, and one outside an instant of it with its verdict.
        ("braking_distance", {}, DISTANCE, [("speed", "band", 440.0, 490.0, None, "it: 440 .. 490 m")]),
        *(("braking_distance", {}, {**DISTANCE, "status": status},
           [("speed", "band", 440.0, 490.0, None, f"it: 440 .. 490 m{ending}"),
            ("speed", "instant", 510.0, 510.0, None, f"510 m{ending}")])
          for status, ending in (("fail", ""), ("inconclusive", " (inconclusive)"))),
        # The first phase is a window with its limit and what was found.
        ("initial_adhesion", {"first_phase_duration": 3.0}, ADHESION,
         [("speed", "window", 5.0, 8.0, None, "first phase, 3 s"),
          ("deceleration", "window", 5.0, 8.0, None, ""),
          ("deceleration", "limit", 5.0, 8.0, 0.08, "limit 0.08 g"),
          ("deceleration", "mean", 5.0, 8.0, 0.06, "mean 0.06 g")]),
        # The limit ends where slides no longer count: 120 km/h less 1 m/s2 is 30 km/h after 25 s.
        ("maximum_slide_above_cutoff", {"low_speed_cutoff": 30 / 3.6}, {"unit": "%", "upper": 35.0},
         [("slide", "limit", None, 25.0, 35.0, "limit 35 %")]),
    ],
)  # fmt: skip
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


def test_the_largest_slide_of_each_wheelset_and_vents_too_many_are_marked(marks):
    limits = {"unit": "%", "lower": 60.0, "value": 40.0, "status": "fail"}
    limit, *points = marks("maximum_slide_above_cutoff", CUTOFF, **limits)
    assert limit.kind == "limit"
    # The third is locked later on.
    assert [mark.label for mark in points] == ["1: 40 %", "2: 40 %", "", "4: 40 %"]
    assert {mark.kind for mark in points} == {"point"}
    assert all(mark.x0 is not None and 5.0 < mark.x0 < 15.0 for mark in points if mark.label)
    found = marks("valve_actuations", unit="1", upper=0.0, value=1.0, status="fail")
    assert [(mark.plot, mark.y) for mark in found] == [("valves", float(n)) for n in (1, 2, 3, 4)]
    # From the first to the last.
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


_TRACE = PlotTrace(0.0, 30.0, 0.01, {})
_UPPER = {"lower": None, "upper": 10.0}


def _margins(*verdicts):
    return margins_of(verdicts, verdicts, _TRACE)


def test_failing_criteria_come_first_then_the_narrowest_margins_then_yes_or_no():
    changes = (
        {**_UPPER, "margin": 5.0},
        {"lower": 1.0, "upper": None, "value": 1.0, "margin": 0.0},
        {**_UPPER, "margin": 0.5},
        {**_UPPER, "margin": -1.0, "status": "fail"},
        {**_UPPER, "margin": -30.0, "status": "fail"},
        {"status": "inconclusive", "margin": None},
        {"status": "not_applicable", "margin": None},
    )
    margins = _margins(*(make_verdict(id=str(index), **each) for index, each in enumerate(changes)))
    assert [(each.verdict.id, each.share_text) for each in margins.judged] == [
        *(("4", "4 × limit"), ("3", "-10 %"), ("5", ""), ("2", "+5 %"), ("0", "+50 %"), ("1", "met"))  # noqa: RUF001
    ]
    assert [each.verdict.id for each in margins.not_applicable] == ["6"]


@pytest.mark.parametrize(
    ("share", "bar"),
    [(-250.0, (0.0, 50.0)), (-40.0, (30.0, 20.0)), (60.0, (50.0, 30.0)), (3e4, (50.0, 50.0))],
)
def test_a_bar_begins_at_the_limit_and_ends_with_the_scale(share, bar):
    status = "pass" if share > 0 else "fail"
    (margin,) = _margins(make_verdict(lower=None, upper=2.0, margin=share / 50.0, status=status)).judged
    assert margin.bar == pytest.approx(bar)


def test_the_margin_of_a_limit_of_zero_is_no_share():
    assert margin_share(make_verdict(lower=None, upper=0.0, value=0.2, margin=-0.2, status="fail")) is None


@pytest.mark.parametrize(
    ("margin", "status", "spare", "words"),
    [
        (4.0, "pass", "turns", "fails if d were 0.6 s instead of 0.2 s"),
        (-4.0, "fail", "-40 %", "passes if d were 0.5 s instead of 0.7 s"),
        (0.0, "pass", "turns", "fails if d were 0.6 s instead of 0.2 s"),
    ],
)
def test_a_verdict_that_turns_has_nothing_to_spare_as_where_cases_are_ranked(margin, status, spare, words):
    intervals = (VerdictInterval(0.0, 0.5, "pass"), VerdictInterval(0.6, 1.0, "fail"))
    stated = AppliedDefinition("d", 0.2 if status == "pass" else 0.7, "s", "chosen", 0.0, 1.0)
    turns = {"sensitivity": (Sensitivity("d", "s", 0.0, 1.0, intervals),), "definitions": (stated,)}
    verdict = make_verdict(**_UPPER, margin=margin, status=status, **turns)
    steady = make_verdict(**_UPPER, margin=0.1, status="pass", id="steady")
    shown = _margins(steady, verdict).judged[0]
    assert (shown.verdict.id, shown.share_text, turns_text(shown.verdict)) == (verdict.id, spare, words)
    assert shown.bar[1] == pytest.approx(abs(10.0 * margin) / 2)
    case = CaseResult("c", "s", {}, PASS, "pass", criteria=(steady, verdict))
    narrowest, criterion = narrowest_margin(case)
    assert criterion == verdict.id
    assert shown.to_spare == pytest.approx(100.0 * (narrowest or 0.0))


def _definitions(**values):
    return tuple(AppliedDefinition(name, value, "m/s", "chosen") for name, value in values.items())


def _with(recording, **channels):
    units = {**dict.fromkeys(channels, "1"), **recording.units}
    return Recording({**recording.channels, **channels}, units, recording.metadata)


@pytest.mark.parametrize(
    ("measure", "value", "interval", "wheelset"),
    [
        ("locked_time", 3.0, (10.0, 22.0), 2),
        ("longest_lock", 2.0, (20.0, 22.0), 2),
        ("longest_lock_of_sound_wheelsets", 0.5, (15.0, 15.5), 4),
    ],
)
def test_a_lock_is_that_of_the_wheelset_that_decides(measure, value, interval, wheelset):
    """Wheelset 2, which is faulty, is locked for 1 s and for 2 s, wheelset 4 for 0.5 s."""
    recording = make_recording()
    time, speed = recording["time"], recording["wheel_speed_1"]

    def locked(*spans):
        within = [(time > first + 1e-6) & (time < last + 1e-6) for first, last in spans]
        return np.where(np.logical_or.reduce(within), 0.0, speed)

    locks = {"wheel_speed_2": locked((10.0, 11.0), (20.0, 22.0)), "wheel_speed_4": locked((15.0, 15.5))}
    recording = _in_fault(recording, **locks)
    definitions = _definitions(locked_speed=0.1, moving_speed=1.0)
    verdict = make_verdict(measure=measure, value=value, definitions=definitions)
    taken = taken_at(verdict, trace_of(recording, [verdict]))
    assert (taken.start, taken.end) == pytest.approx(interval, abs=0.011)
    assert (taken.plot, taken.wheelset) == ("locked", wheelset)


def test_a_measure_of_the_train_is_taken_at_an_instant_of_its_own():
    recording = make_recording()
    time = recording["time"]
    lowest = _with(recording, reservoir_pressure=8e5 - 1e5 * np.exp(-((time - 12.0) ** 2)))
    verdict = make_verdict(measure="reservoir_minimum_pressure", value=7.0, unit="bar")
    taken = taken_at(verdict, trace_of(lowest, [verdict]))
    assert taken.start == taken.end == pytest.approx(12.0, abs=0.011)
    assert (taken.plot, taken.wheelset, taken.value) == ("pressure", None, pytest.approx(7.0, abs=1e-6))


def _in_fault(recording, **channels):
    active = np.where((recording["time"] > 5.0) & (recording["time"] < 9.0), 2.0, 0.0)
    faulty = _with(recording, active_faults=active, **channels)
    return Recording(
        faulty.channels, faulty.units, {**faulty.metadata, "faults": "brake-line-leak, speed-sensor-stuck-2"}
    )


def test_the_reference_is_furthest_off_after_the_first_fault():
    """It is 3 m/s too high at 2 s, before the fault, and 2 m/s at 12 s."""
    recording = make_recording()
    time, speed = recording["time"], recording["speed"]
    excess = 3.0 * np.exp(-((time - 2.0) ** 2)) + 2.0 * np.exp(-((time - 12.0) ** 2))
    faulty = _in_fault(recording, reference_speed=speed + excess)
    definitions = _definitions(moving_speed=1.0)
    verdict = make_verdict(measure="reference_excess", value=7.2, unit="km/h", definitions=definitions)
    taken = taken_at(verdict, trace_of(faulty, [verdict]))
    assert taken.start == pytest.approx(12.0, abs=0.011)
    assert taken.value == pytest.approx((120 / 3.6 - 12.0 + 2.0) * 3.6, abs=0.1)


@pytest.mark.parametrize(
    ("measure", "value"), [("contact_energy", 1.0), ("braking_distance", None), ("locked_time", 0.0)]
)
def test_what_has_no_place_in_the_plots_has_none(measure, value):
    assert taken_at(make_verdict(measure=measure, value=value), _TRACE) is None
