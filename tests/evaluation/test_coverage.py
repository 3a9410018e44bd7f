"""What is decided of a stop that was not observed as a whole: only what the rest cannot change."""

import math

import pytest
from hypothesis import given, strategies as st

from uictest.judging.evaluation import Coverage, MissingData, evaluate, judge

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


@pytest.fixture(scope="session")
def locked(criterion, stop, wheelsets, verdict_of):
    """Judge the times that the wheelsets are locked."""

    def judged(times, running=False, coverage=None, **fields):
        bounded = criterion("locked_time", **fields)
        records = wheelsets(0.0, 0.0, 0.0, 0.0, locked_time=times)
        return verdict_of(bounded, stop(**(RUNNING if running else {})), records, coverage)

    return judged


def test_an_upper_bound_on_what_can_only_grow_is_open_until_it_is_exceeded(locked):
    kept = locked([0.0, 0.0, 0.4, 0.0], running=True, upper="1 s", wheelsets="all")
    assert (kept.status, kept.value, kept.margin) == ("inconclusive", None, None)
    assert kept.reason == f"4 of 4 wheelsets must be within the limit of 1 s: 0, 0, 0.4, 0 s so far; {ENDED}"
    broken = locked([0.0, 3.0, 0.4, 2.0], running=True, upper="1 s", wheelsets="all")
    assert (broken.status, broken.value, broken.margin) == ("fail", 3.0, -2.0)
    assert broken.reason == (
        f"2 of 4 wheelsets not within the limit of 1 s (4 needed): 0, 3, 0.4, 2 s so far; {ENDED}"
    )


def test_a_lower_bound_on_what_can_only_grow_passes_once_it_is_reached(
    criterion, stop, wheelsets, verdict_of
):
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
def test_before_standstill_a_measure_is_judged_by_what_it_can_still_become(
    criterion, stop, verdict_of, name, bound, fields, verdict
):
    assert verdict_of(criterion(name, **bound), stop(**RUNNING, **fields)).status == verdict


def test_a_first_phase_that_is_over_is_final_and_one_that_is_not_is_open(
    criterion, sliding_stop, stop, verdict_of
):
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
def test_what_is_decided_early_is_decided_as_the_whole_stop_is(locked, so_far, more, bound, needed, upper):
    fields = {"upper" if upper else "lower": f"{bound:.6f} s", "wheelsets": {"at_least": needed}}
    early = locked(so_far, running=True, **fields)
    whole = locked([a + b for a, b in zip(so_far, more, strict=True)], **fields)
    assert early.status in (whole.status, "inconclusive")


@given(
    seconds, st.lists(st.booleans(), min_size=4, max_size=4), seconds, st.floats(0.0, 12.0), st.integers(1, 4)
)
def test_a_wheelset_that_is_not_known_counts_either_way(locked, known, lacking, other, bound, needed):
    fields = {"upper": f"{bound:.6f} s", "wheelsets": {"at_least": needed}}
    coverage = Coverage({"locked_time": tuple(NOWHERE if lacks else None for lacks in lacking)})
    early = locked(known, coverage=coverage, **fields)
    possible = [b if lacks else a for a, b, lacks in zip(known, other, lacking, strict=True)]
    assert early.status in (locked(possible, **fields).status, "inconclusive")
    if not any(lacking):
        assert early.status != "inconclusive"


def test_three_known_wheelsets_can_decide_for_four_and_a_gap_leaves_what_was_seen_besides_it(locked):
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


def test_checks_of_the_rig_say_nothing_about_a_recorded_stop(shipped, scenario, case, stop, wheelsets):
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


def test_without_the_initial_speed_a_criterion_that_asks_for_one_is_open(shipped, scenario, stop, wheelsets):
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
