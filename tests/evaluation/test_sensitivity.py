import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.judging.evaluation.bounds import ObservedStop, bounds_of
from uictest.judging.evaluation.decision import Decision, decide, sensitivity

G = 9.80665
KMH = 1 / 3.6
TOLERANCE = 1e-5
speeds = st.lists(st.floats(0.0, 1.5), min_size=10, max_size=10).map(
    lambda falls: 33.0 - np.cumsum([0.0, *falls])
)


@pytest.fixture(scope="session")
def adhesion(criterion):
    phase = {"first_phase_duration": {"value": "3 s", "range": ["1.5 s", "5.5 s"]}}
    return criterion("initial_adhesion", lower="0.05 g", upper="0.08 g", definition=phase)


@pytest.fixture(scope="session")
def slide(criterion):
    cutoff = {"low_speed_cutoff": {"value": "30 km/h", "range": ["10 km/h", "60 km/h"]}}
    return criterion(
        "maximum_slide_above_cutoff",
        lower="35 %",
        strict=True,
        wheelsets={"at_least": "half"},
        definition=cutoff,
    )


@pytest.fixture(scope="session")
def moved(verdict_of):
    """Judge a stop by one criterion; how its verdict moves with its one definition."""

    def judged(criterion, measures, records):
        (only,) = verdict_of(criterion, measures, records).sensitivity
        return only

    return judged


def test_where_the_verdict_flips_is_located_and_one_that_holds_is_one_stretch(
    adhesion, moved, sliding_stop, wheelsets
):
    steady = moved(adhesion, sliding_stop(0.07 * G), wheelsets(0.5))
    assert not steady.flips
    assert str(steady) == "first_phase_duration 1.5 .. 5.5 s: pass throughout"
    # 0.07 g for two seconds, then 0.09 g: the mean reaches 0.08 g after four.
    falls = np.array([0.07, 0.07, *[0.09] * 8]) * G
    measures = sliding_stop(speed_after_sliding=33.0 - np.cumsum([0.0, *falls]))
    found = moved(adhesion, measures, wheelsets(0.5))
    assert [interval.status for interval in found.intervals] == ["pass", "fail"]
    assert found.intervals[0].first == 1.5
    assert found.intervals[0].last == pytest.approx(4.0, abs=1e-5)
    assert found.intervals[1].last == 5.5
    assert str(found) == "first_phase_duration 1.5 .. 5.5 s: pass 1.5 .. 4, fail 4 .. 5.5"


def test_a_record_too_short_for_part_of_the_range_shows(adhesion, moved, sliding_stop, wheelsets):
    speed = 33.0 - 0.07 * G * np.arange(11.0)
    speed[5:] = np.nan
    found = moved(adhesion, sliding_stop(speed_after_sliding=speed), wheelsets(0.5))
    assert [interval.status for interval in found.intervals] == ["pass", "not_applicable"]
    assert found.intervals[0].last == pytest.approx(4.0, abs=1e-5)


def test_both_bounds_crossed_within_a_second_are_both_found(criterion, moved, sliding_stop, wheelsets):
    phase = {"first_phase_duration": {"value": "1 s", "range": ["1 s", "2 s"]}}
    narrow = criterion("initial_adhesion", lower="1.5 m/s2", upper="1.6 m/s2", definition=phase)
    measures = sliding_stop(speed_after_sliding=[30.0, 29.0, 26.0, *[25.0] * 8])
    found = moved(narrow, measures, wheelsets(0.5))
    assert [interval.status for interval in found.intervals] == ["fail", "pass", "fail"]


def test_a_definition_in_classes_is_tried_in_each_of_them(slide, moved, stop, wheelsets):
    records = wheelsets(0.9, 0.9, 0.1, 0.1)
    records.maximum_slide_above[0, 5:] = 0.2
    found = moved(slide, stop(), records)
    assert str(found) == "low_speed_cutoff 10 .. 60 km/h: pass 10 .. 40, fail 50 .. 60"


@given(speeds, st.floats(1.5, 5.5))
def test_the_intervals_agree_with_deciding_at_any_duration(
    adhesion, moved, sliding_stop, wheelsets, speed, duration
):
    measures = sliding_stop(speed_after_sliding=speed)
    found = moved(adhesion, measures, wheelsets(0.5))
    direct = decide(
        adhesion,
        bounds_of(adhesion),
        {"first_phase_duration": duration, "gradient": 0.0},
        ObservedStop(measures, wheelsets(0.5)),
    ).status
    nearby = {s.status for s in found.intervals if s.first - TOLERANCE <= duration <= s.last + TOLERANCE}
    assert direct in nearby


@given(st.lists(st.floats(0.0, 1.0), min_size=84, max_size=84), st.integers(1, 6))
def test_the_intervals_agree_with_deciding_at_any_cutoff(slide, moved, stop, wheelsets, slides, k):
    records = wheelsets(0.0, 0.0, 0.0, 0.0)
    records.maximum_slide_above = np.reshape(slides, (4, 21))
    found = moved(slide, stop(), records)
    direct = decide(
        slide, bounds_of(slide), {"low_speed_cutoff": 10 * k * KMH}, ObservedStop(stop(), records)
    ).status
    assert [s.status for s in found.intervals if s.first <= 10 * k <= s.last] == [direct]


def test_a_range_of_one_value_is_decided_there():
    only = sensitivity("first_phase_duration", "s", 3.0, 3.0, None, lambda at: Decision("pass", at, ""))
    assert [(s.first, s.last) for s in only.intervals] == [(3.0, 3.0)]
