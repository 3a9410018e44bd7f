"""One criterion decided: bounds, part of a stop, and where another definition flips the verdict."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, strategies as st

from uictest.judging.evaluation import Coverage, MissingData, evaluate, judge
from uictest.judging.evaluation.decision import (
    Bounds,
    Decision,
    ObservedStop,
    bounds_of,
    decide,
    deciding,
    sensitivity,
)

from ..measures.catalogue.conftest import sliding_stop, stop, wheelsets
from .conftest import case, criterion, scenario, shipped, verdict_of

any_number = st.floats(allow_nan=True, allow_infinity=True)
number = st.floats(-1e9, 1e9)


@st.composite
def some_bounds(draw):
    lower, upper = draw(st.none() | number), draw(st.none() | number)
    assume(lower is not None or upper is not None)
    assume(lower is None or upper is None or lower <= upper)
    return Bounds(lower, upper, draw(st.booleans()))


@given(some_bounds())
def test_nan_and_infinity_never_hold(bounds):
    assert not any(map(bounds.hold, (math.nan, math.inf, -math.inf)))


@given(some_bounds(), number)
def test_the_margin_is_positive_inside_and_negative_outside(bounds, value):
    margin = bounds.margin(value)
    assert (margin < 0) == (bounds.side(value) != 0)
    assert bounds.hold(value) == (margin > 0 or (margin == 0 and not bounds.strict))


@given(number, st.booleans(), number, number)
def test_what_lies_farther_beyond_a_bound_never_turns_fail_into_pass(limit, strict, a, b):
    upper, lower = Bounds(None, limit, strict), Bounds(limit, None, strict)
    assert upper.hold(min(a, b)) or not upper.hold(max(a, b))
    assert lower.hold(max(a, b)) or not lower.hold(min(a, b))


@given(some_bounds(), st.lists(any_number, min_size=1, max_size=4), st.data())
def test_the_deciding_value_holds_if_and_only_if_enough_values_do(bounds, values, data):
    needed = data.draw(st.integers(1, len(values)))
    assert bounds.hold(deciding(values, bounds, needed)) == (sum(map(bounds.hold, values)) >= needed)


@pytest.mark.parametrize(
    ("bounds", "shown"),
    [
        (Bounds(None, 0.08, strict=True), "< 0.08"),
        (Bounds(35.0, None), ">= 35"),
        (Bounds(440.0, 490.0), "440 .. 490"),
    ],
)
def test_bounds_are_printed_as_an_engineer_writes_them(bounds, shown):
    assert str(bounds) == shown


KMH = 1 / 3.6
ENDED = "the simulation ended after 60 s at 43.2 km/h; raise `simulation.maximum_duration`"
RUNNING = {
    "stopped": 0.0,
    "braking_distance": math.nan,
    "end_speed": 12.0,
    "end_time": 2.0,
    "end_distance": 60.0,
}
NOWHERE = MissingData("not recorded: wheel_speed_2", bounded=False)
GAP = MissingData("wheel_speed_2 is not known from 1 to 2 s")
seconds = st.lists(st.floats(0.0, 10.0), min_size=4, max_size=4)


def locked(times, running=False, coverage=None, **fields):
    """Judge the times that the wheelsets are locked."""
    bounded = criterion("locked_time", **fields)
    records = wheelsets(0.0, 0.0, 0.0, 0.0, locked_time=times)
    return verdict_of(bounded, stop(**(RUNNING if running else {})), records, coverage)


def test_an_upper_bound_on_what_can_only_grow_is_open_until_it_is_exceeded():
    kept = locked([0.0, 0.0, 0.4, 0.0], running=True, upper="1 s", wheelsets="all")
    assert (kept.status, kept.value, kept.margin) == ("inconclusive", None, None)
    assert kept.reason == f"4 of 4 wheelsets must be within the limit of 1 s: 0, 0, 0.4, 0 s so far; {ENDED}"
    broken = locked([0.0, 3.0, 0.4, 2.0], running=True, upper="1 s", wheelsets="all")
    assert (broken.status, broken.value, broken.margin) == ("fail", 3.0, -2.0)
    assert broken.reason == (
        f"2 of 4 wheelsets not within the limit of 1 s (4 needed): 0, 3, 0.4, 2 s so far; {ENDED}"
    )


def test_a_lower_bound_on_what_can_only_grow_passes_once_it_is_reached():
    cutoff = {"low_speed_cutoff": {"value": "30 km/h", "range": ["10 km/h", "60 km/h"]}}
    slide = criterion(
        "maximum_slide_above_cutoff", lower="35 %", wheelsets={"at_least": "half"}, definition=cutoff
    )
    passed = verdict_of(slide, stop(**RUNNING), wheelsets(0.2, 0.9, 0.3, 0.8))
    assert (passed.status, passed.value, passed.margin) == ("pass", 80.0, 45.0)
    assert passed.reason == (
        f"2 of 4 wheelsets at or above 35 % (2 needed): 20, 90, 30, 80 % (above 30 km/h) so far; {ENDED}"
    )
    assert verdict_of(slide, stop(**RUNNING), wheelsets(0.2, 0.9, 0.3, 0.3)).status == "inconclusive"


@pytest.mark.parametrize(
    ("name", "bound", "fields", "verdict"),
    [
        ("minimum_deceleration", {"lower": "0.5 m/s2"}, {"minimum_deceleration": 0.4}, "fail"),
        ("minimum_deceleration", {"lower": "0.5 m/s2"}, {"minimum_deceleration": 0.6}, "inconclusive"),
        ("minimum_deceleration", {"upper": "0.5 m/s2"}, {"minimum_deceleration": 0.4}, "pass"),
        ("minimum_deceleration", {"lower": "0.5 m/s2"}, {"minimum_deceleration": math.nan}, "inconclusive"),
        ("reservoir_minimum_pressure", {"lower": "5 bar"}, {"reservoir_minimum_pressure": 4e5}, "fail"),
        ("reservoir_minimum_pressure", {"lower": "5 bar"}, {}, "inconclusive"),
        ("mean_deceleration", {"lower": "20 m/s2"}, {}, "fail"),  # 120 km/h within 60 m are 9.3 m/s2
        ("mean_deceleration", {"lower": "1 m/s2"}, {}, "inconclusive"),
        ("maximum_deceleration", {"upper": "1 m/s2"}, {}, "fail"),
        ("maximum_deceleration", {"upper": "2 m/s2"}, {}, "inconclusive"),
        ("braking_time", {"upper": "1 s"}, {}, "fail"),
        ("braking_time", {"lower": "1 s"}, {}, "pass"),
        ("braking_time", {"upper": "30 s"}, {}, "inconclusive"),
        ("air_consumed", {"upper": "50 NL"}, {}, "fail"),
        ("energy_residual", {"upper": "0.1 %"}, {}, "pass"),
        ("energy_residual", {"upper": "0.1 %"}, {"energy_residual": 0.5}, "fail"),
        ("standstill", {"lower": 1}, {}, "inconclusive"),
    ],
)
def test_before_standstill_a_measure_is_judged_by_what_it_can_still_become(name, bound, fields, verdict):
    assert verdict_of(criterion(name, **bound), stop(**RUNNING, **fields)).status == verdict


def test_a_first_phase_that_is_over_is_final_and_one_that_is_not_is_open():
    phase = {"first_phase_duration": {"value": "3 s", "range": ["2 s", "5 s"]}}
    slippery = criterion("initial_adhesion", upper="0.08 g", definition=phase)
    assert verdict_of(slippery, sliding_stop(**RUNNING)).status == "pass"
    speed = [33.0, 32.0, *[math.nan] * 9]
    unfinished = sliding_stop(**RUNNING, speed_after_sliding=speed)
    assert verdict_of(slippery, unfinished).status == "inconclusive"
    assert verdict_of(slippery, sliding_stop(speed_after_sliding=speed)).status == "not_applicable"
    unslid = verdict_of(slippery, stop(**RUNNING))
    assert (unslid.status, unslid.reason) == (
        "inconclusive",
        f"no wheelset slid, so the first phase has no beginning; {ENDED}",
    )


@given(seconds, seconds, st.floats(0.0, 12.0), st.integers(1, 4), st.booleans())
def test_what_is_decided_early_is_decided_as_the_whole_stop_is(so_far, more, bound, needed, upper):
    fields = {"upper" if upper else "lower": f"{bound:.6f} s", "wheelsets": {"at_least": needed}}
    early = locked(so_far, running=True, **fields)
    whole = locked([a + b for a, b in zip(so_far, more, strict=True)], **fields)
    assert early.status in (whole.status, "inconclusive")


@given(
    seconds, st.lists(st.booleans(), min_size=4, max_size=4), seconds, st.floats(0.0, 12.0), st.integers(1, 4)
)
def test_a_wheelset_that_is_not_known_counts_either_way(known, lacking, other, bound, needed):
    fields = {"upper": f"{bound:.6f} s", "wheelsets": {"at_least": needed}}
    coverage = Coverage({"locked_time": tuple(NOWHERE if lacks else None for lacks in lacking)})
    early = locked(known, coverage=coverage, **fields)
    possible = [b if lacks else a for a, b, lacks in zip(known, other, lacking, strict=True)]
    assert early.status in (locked(possible, **fields).status, "inconclusive")
    if not any(lacking):
        assert early.status != "inconclusive"


def test_three_known_wheelsets_can_decide_for_four_and_a_gap_leaves_what_was_seen_besides_it():
    coverage = Coverage({"locked_time": (None, NOWHERE, None, None)})
    half = {"upper": "1 s", "wheelsets": {"at_least": "half"}}
    found = locked([0.0, math.nan, 0.2, 5.0], coverage=coverage, **half)
    assert (found.status, found.value) == ("pass", 0.2)
    count = "2 of 4 wheelsets within the limit of 1 s (2 needed)"
    assert found.reason == f"{count}: 0, -, 0.2, 5 s so far; not recorded: wheel_speed_2"
    every = locked([0.0, math.nan, 0.2, 0.3], coverage=coverage, upper="1 s", wheelsets="all")
    assert every.status == "inconclusive"
    coverage = Coverage({"locked_time": (None, GAP, None, None)})
    every = {"upper": "1 s", "wheelsets": "all", "coverage": coverage}
    missed = locked([0.0, 2.0, 0.0, 0.0], **every)
    assert (missed.status, missed.missed_by) == ("fail", (2,))
    assert locked([0.0, 0.5, 0.0, 0.0], **every).status == "inconclusive"


def test_checks_of_the_rig_say_nothing_about_a_recorded_stop():
    measures = stop(energy_residual=math.nan, air_residual=math.nan, air_energy_residual=math.nan)
    records = wheelsets(0.1, 0.1, 0.1, 0.1)
    profile = shipped("uictest-stop")
    judged = scenario(profile)
    judged.judged_by = (*judged.criteria, shipped("uictest-rig"))
    result = evaluate(case(judged), measures, records, coverage=Coverage({}))
    assert result.outcome == "pass"
    assert [v.id for v in result.criteria] == [criterion.id for criterion in profile.criteria]
    named = evaluate(case(scenario(shipped("uictest-rig"))), measures, records, coverage=Coverage({}))
    assert {v.status for v in named.criteria} == {"not_applicable"}


def test_without_the_initial_speed_a_criterion_that_asks_for_one_is_open():
    coverage = Coverage({}, "the record begins after the brake command: no initial speed")
    measures = stop(initial_speed=90 * KMH, braking_distance=470.0)
    dry, wet = (
        judge(
            scenario(shipped("uic-541-05-appendix-b"), condition=rail),
            measures,
            wheelsets(0.1),
            coverage=coverage,
        )[2]
        for rail in ("dry", "wet")
    )
    assert (dry.status, dry.reason) == ("inconclusive", coverage.no_initial_speed)
    assert (wet.status, wet.reason) == ("not_applicable", "rail is wet, the criterion is for dry")


G = 9.80665
TOLERANCE = 1e-5
speeds = st.lists(st.floats(0.0, 1.5), min_size=10, max_size=10).map(
    lambda falls: 33.0 - np.cumsum([0.0, *falls])
)


@pytest.fixture(scope="session")
def adhesion():
    phase = {"first_phase_duration": {"value": "3 s", "range": ["1.5 s", "5.5 s"]}}
    return criterion("initial_adhesion", lower="0.05 g", upper="0.08 g", definition=phase)


@pytest.fixture(scope="session")
def slide():
    cutoff = {"low_speed_cutoff": {"value": "30 km/h", "range": ["10 km/h", "60 km/h"]}}
    return criterion(
        "maximum_slide_above_cutoff",
        lower="35 %",
        strict=True,
        wheelsets={"at_least": "half"},
        definition=cutoff,
    )


def moved(criterion, measures, records):
    """Judge a stop by one criterion; how its verdict moves with its one definition."""
    (only,) = verdict_of(criterion, measures, records).sensitivity
    return only


def test_where_the_verdict_flips_is_located_and_one_that_holds_is_one_stretch(adhesion):
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


def test_both_bounds_crossed_within_a_second_are_found_and_a_record_too_short_for_the_range_shows(adhesion):
    speed = 33.0 - 0.07 * G * np.arange(11.0)
    speed[5:] = np.nan
    found = moved(adhesion, sliding_stop(speed_after_sliding=speed), wheelsets(0.5))
    assert [interval.status for interval in found.intervals] == ["pass", "not_applicable"]
    assert found.intervals[0].last == pytest.approx(4.0, abs=1e-5)
    phase = {"first_phase_duration": {"value": "1 s", "range": ["1 s", "2 s"]}}
    narrow = criterion("initial_adhesion", lower="1.5 m/s2", upper="1.6 m/s2", definition=phase)
    measures = sliding_stop(speed_after_sliding=[30.0, 29.0, 26.0, *[25.0] * 8])
    found = moved(narrow, measures, wheelsets(0.5))
    assert [interval.status for interval in found.intervals] == ["fail", "pass", "fail"]


def test_a_definition_in_classes_is_tried_in_each_and_a_range_of_one_value_there(slide):
    records = wheelsets(0.9, 0.9, 0.1, 0.1)
    records.maximum_slide_above[0, 5:] = 0.2
    found = moved(slide, stop(), records)
    assert str(found) == "low_speed_cutoff 10 .. 60 km/h: pass 10 .. 40, fail 50 .. 60"
    only = sensitivity("first_phase_duration", "s", 3.0, 3.0, None, lambda at: Decision("pass", at, ""))
    assert [(s.first, s.last) for s in only.intervals] == [(3.0, 3.0)]


@given(speeds, st.floats(1.5, 5.5))
def test_the_intervals_agree_with_deciding_at_any_duration(adhesion, speed, duration):
    measures = sliding_stop(speed_after_sliding=speed)
    found = moved(adhesion, measures, wheelsets(0.5))
    direct = decide(
        adhesion,
        bounds_of(adhesion),
        {"first_phase_duration": duration, "gradient": 0.0},
        ObservedStop(scenario(), measures, wheelsets(0.5)),
    ).status
    nearby = {s.status for s in found.intervals if s.first - TOLERANCE <= duration <= s.last + TOLERANCE}
    assert direct in nearby


@given(st.lists(st.floats(0.0, 1.0), min_size=84, max_size=84), st.integers(1, 6))
def test_the_intervals_agree_with_deciding_at_any_cutoff(slide, slides, k):
    records = wheelsets(0.0, 0.0, 0.0, 0.0)
    records.maximum_slide_above = np.reshape(slides, (4, 21))
    found = moved(slide, stop(), records)
    direct = decide(
        slide, bounds_of(slide), {"low_speed_cutoff": 10 * k * KMH}, ObservedStop(scenario(), stop(), records)
    ).status
    assert [s.status for s in found.intervals if s.first <= 10 * k <= s.last] == [direct]
