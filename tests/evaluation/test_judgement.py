import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.judging.evaluation import AppliedDefinition, judge

G = 9.80665
KMH = 1 / 3.6
ENDED = "the simulation ended after 60 s at 43.2 km/h; raise `simulation.maximum_duration`"
positive = st.floats(0.0, 1e4)


@pytest.fixture
def appendix_b(shipped):
    return shipped("uic-541-05-appendix-b")


def by_id(verdicts):
    return {verdict.id: verdict for verdict in verdicts}


def test_a_slip_test_is_judged_by_adhesion_and_slide_but_not_by_distance(
    appendix_b, scenario, sliding_stop, wheelsets
):
    verdicts = by_id(
        judge(scenario(appendix_b, condition="wet"), sliding_stop(0.07 * G), wheelsets(0.2, 0.9, 0.3, 0.8))
    )
    adhesion = verdicts["initial-adhesion"]
    assert (adhesion.status, adhesion.unit, adhesion.upper, adhesion.layer) == ("pass", "g", 0.08, "validity")
    assert adhesion.value == pytest.approx(0.07)
    assert adhesion.margin == pytest.approx(0.01)
    slide = verdicts["minimum-slide"]
    assert (slide.status, slide.value, slide.lower, slide.unit) == ("pass", 75.0, 35.0, "%")
    assert slide.margin == pytest.approx(40.0)
    assert slide.reason == "75 % (from the brake command to 60 km/h) keeps > 35 % by 40 %"
    distance = verdicts["braking-distance"]
    assert (distance.status, distance.value, distance.margin) == ("not_applicable", None, None)
    assert distance.reason == "rail is wet, the criterion is for dry"


def test_a_dry_stop_is_judged_by_distance_alone(appendix_b, scenario, stop, wheelsets):
    verdicts = by_id(judge(scenario(appendix_b), stop(braking_distance=512.0), wheelsets(0.0, 0.0, 0.0, 0.0)))
    assert [v.status for v in verdicts.values()] == ["not_applicable", "not_applicable", "fail"]
    distance = verdicts["braking-distance"]
    assert (distance.lower, distance.upper, distance.margin) == (440.0, 490.0, -22.0)
    assert distance.reason == "512 m misses 440 .. 490 m by 22 m"


def test_exactly_at_a_limit_below_and_above_do_not_hold_but_a_range_does(
    appendix_b, scenario, stop, sliding_stop, wheelsets
):
    wet = by_id(
        judge(scenario(appendix_b, condition="wet"), sliding_stop(share=0.35), wheelsets(0.9, 0.9, 0.9, 0.9))
    )
    assert wet["minimum-slide"].status == "fail"
    for distance in (440.0, 490.0):
        dry = by_id(judge(scenario(appendix_b), stop(braking_distance=distance), wheelsets(0.0)))
        assert dry["braking-distance"].status == "pass"


@pytest.mark.parametrize(
    ("changes", "speed", "reason"),
    [
        ({"position": "G"}, 120, "brake position is G, the criterion is for R"),
        ({}, 124, "initial speed is 124 km/h, the criterion is for 120 +- 3 km/h"),
        ({"command": 0.8}, 120, "brake command is 80 %, the criterion is for 100 +- 0 %"),
        ({"gradient": -0.02}, 120, "gradient is -20 permille, the criterion is for 0 +- 1 permille"),
        (
            {"position": "P", "condition": "wet"},
            120,
            "rail is wet, the criterion is for dry; brake position is P,",
        ),
        ({}, math.nan, "initial speed is nan km/h"),
    ],
)
def test_what_keeps_a_criterion_from_applying_is_said(
    appendix_b, scenario, stop, wheelsets, changes, speed, reason
):
    measures = stop(initial_speed=speed * KMH)
    verdict = by_id(judge(scenario(appendix_b, **changes), measures, wheelsets(0.0)))["braking-distance"]
    assert verdict.status == "not_applicable"
    assert verdict.reason.startswith(reason)
    assert verdict.sensitivity == ()


@pytest.mark.parametrize("speed", [117.0, 119.3, 123.0])
def test_within_the_tolerance_the_distance_is_judged_uncorrected(
    appendix_b, scenario, stop, wheelsets, speed
):
    measures = stop(initial_speed=speed * KMH, braking_distance=470.0)
    verdict = by_id(judge(scenario(appendix_b), measures, wheelsets(0.0)))["braking-distance"]
    assert (verdict.status, verdict.value) == ("pass", 470.0)
    assert "not corrected" in verdict.definition["measure"]


def test_a_wet_stop_without_sliding_says_so_and_is_no_slip_test(appendix_b, scenario, stop, wheelsets):
    verdicts = by_id(judge(scenario(appendix_b, condition="wet"), stop(), wheelsets(0.01, 0.01, 0.01, 0.01)))
    assert verdicts["initial-adhesion"].status == "not_applicable"
    assert "no wheelset slid" in verdicts["initial-adhesion"].reason
    assert verdicts["minimum-slide"].status == "fail"


def test_a_train_already_beyond_the_upper_bound_has_failed_before_it_stands(criterion, verdict_of, stop):
    bounded = criterion(lower="440 m", upper="490 m")
    running = {"stopped": 0.0, "braking_distance": np.nan, "end_speed": 12.0, "end_time": 60.0}
    far = verdict_of(bounded, stop(**running, end_distance=900.0))
    assert (far.status, far.value, far.margin) == ("fail", 900.0, -410.0)
    assert far.reason == f"900 m so far; {ENDED}"
    near = verdict_of(bounded, stop(**running, end_distance=460.0))
    assert (near.status, near.value, near.margin) == ("inconclusive", None, None)
    assert near.reason == f"460 m so far; {ENDED}"


@pytest.mark.parametrize("measure", ["longest_lock", "locked_time", "sliding_duration"])
def test_a_train_slower_than_the_speed_of_observation_does_not_show_that_no_wheelset_locked(
    criterion, verdict_of, stop, measure
):
    short = criterion(measure, upper="1 s", wheelsets="all")
    slow = stop(initial_speed=9.0 / 3.6, maximum_deceleration=math.nan)
    gaining = stop(initial_speed=9.0 / 3.6)
    unobserved = verdict_of(short, slow)
    assert unobserved.status == "not_applicable"
    assert "`moving_speed` (10 km/h)" in unobserved.reason
    assert verdict_of(short, gaining).status == "pass"
    assert verdict_of(criterion(lower="440 m"), slow).status == "pass"


@pytest.mark.parametrize(
    ("wheelsets_keep", "slides", "verdict", "value"),
    [
        ("all", (0.4, 0.5, 0.6, 0.3), "fail", 30.0),
        ("any", (0.1, 0.2, 0.4, 0.3), "pass", 40.0),
        ({"at_least": "half"}, (0.1, 0.5, 0.4, 0.3), "pass", 40.0),
        ({"at_least": 3}, (0.1, 0.5, 0.4, 0.3), "fail", 30.0),
        ("all", (0.4, 0.5, math.nan, 0.6), "fail", None),
        ({"at_least": 3}, (0.4, 0.5, math.nan, 0.6), "pass", 40.0),
    ],
)
def test_the_wheelset_that_decides_gives_the_value(
    criterion, verdict_of, stop, wheelsets, wheelsets_keep, slides, verdict, value
):
    cutoff = {"low_speed_cutoff": {"value": "30 km/h", "range": ["30 km/h", "30 km/h"]}}
    slide = criterion("maximum_slide_above_cutoff", lower="35 %", wheelsets=wheelsets_keep, definition=cutoff)
    found = verdict_of(slide, stop(), wheelsets(*slides))
    assert (found.status, found.value) == (verdict, value)


def test_a_record_of_fewer_wheelsets_than_needed_supports_no_verdict(criterion, verdict_of, stop, wheelsets):
    locked = criterion("locked_time", upper="1 s", wheelsets={"at_least": 3})
    found = verdict_of(locked, stop(), wheelsets(0.1, 0.1))
    assert (found.status, found.reason) == ("inconclusive", "the record holds 2 wheelsets")


def test_the_verdict_carries_what_it_was_taken_to_mean_as_text_and_as_data(
    appendix_b, scenario, sliding_stop, wheelsets
):
    verdicts = by_id(
        judge(scenario(appendix_b, condition="wet"), sliding_stop(), wheelsets(0.5, 0.5, 0.5, 0.5))
    )
    adhesion = verdicts["initial-adhesion"].definition
    assert adhesion["clause"] == "Appendix B"
    assert adhesion["bound"] == "< 0.08 g"
    assert adhesion["first_phase_duration"] == "3 s (chosen; range 2 s .. 5 s)"
    assert adhesion["sliding_slide"] == "5 % (chosen)"
    slide = verdicts["minimum-slide"].definition
    assert slide["reading"].startswith("half-at-once (published: TB/T 3009-2019: inferred from")
    assert slide["sliding_below"] == "90 % (published; range 85 % .. 95 %)"
    assert slide["end_speed"] == "60 km/h (published; range 40 km/h .. 80 km/h)"
    adhesion = verdicts["initial-adhesion"]
    assert adhesion.measure == "initial_adhesion"
    assert adhesion.definitions[0] == AppliedDefinition("first_phase_duration", 3.0, "s", "chosen", 2.0, 5.0)
    assert [each.name for each in adhesion.definitions[1:]] == [
        "sliding_slide",
        "sliding_slip",
        "moving_speed",
    ]
    assert adhesion.defined("moving_speed") == pytest.approx(10 / 3.6)
    assert verdicts["minimum-slide"].defined("end_speed") == pytest.approx(60 / 3.6)


@pytest.mark.parametrize(
    "name", ["braking_distance", "initial_adhesion", "energy_residual", "reservoir_minimum_pressure"]
)
@pytest.mark.parametrize("nan", [math.nan, math.inf, -math.inf])
def test_nan_never_passes(criterion, verdict_of, sliding_stop, wheelsets, name, nan):
    phase = {"first_phase_duration": {"value": "3 s", "range": ["2 s", "5 s"]}}
    bounds = {
        "braking_distance": {"upper": "490 m"},
        "initial_adhesion": {"upper": "0.08 g", "definition": phase},
        "energy_residual": {"upper": "0.1 %"},
        "reservoir_minimum_pressure": {"lower": "5 bar"},
    }
    fields = ("braking_distance", "energy_residual", "reservoir_minimum_pressure")
    measures = sliding_stop(**dict.fromkeys(fields, nan), speed_after_sliding=nan)
    found = verdict_of(criterion(name, **bounds[name]), measures, wheelsets(nan))
    assert found.status != "pass"
    assert found.reason


@given(st.tuples(positive, positive), positive)
def test_a_longer_stop_never_turns_fail_into_pass_under_an_upper_bound(
    criterion, verdict_of, stop, distances, bound
):
    limited = criterion(upper=f"{bound:.6f} m")
    shorter, longer = (verdict_of(limited, stop(braking_distance=s)) for s in sorted(distances))
    assert (shorter.status, longer.status) != ("fail", "pass")
    assert shorter.margin >= longer.margin


@given(positive, positive)
def test_the_margin_has_the_sign_of_the_verdict(criterion, verdict_of, stop, distance, bound):
    for side in ("lower", "upper"):
        found = verdict_of(criterion(**{side: f"{bound:.6f} m"}), stop(braking_distance=distance))
        assert (found.margin >= 0) == (found.status == "pass")
