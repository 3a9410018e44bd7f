"""Criteria applied to a stop: which apply, what they say, and what their verdicts carry."""

import math

import jsonschema
import numpy as np
import pytest
from hypothesis import given, strategies as st
from pydantic import ValidationError

from uictest.judging.evaluation import AppliedDefinition, judge, outcome_of
from uictest.plans import scenario as scenarios
from uictest.plans.scenario.parts.criteria import Criteria
from uictest.plans.scenario.yaml.model import quantities_in

from ..measures.catalogue.conftest import sliding_stop, stop, wheelsets
from .conftest import criterion, profile, scenario, shipped, verdict_of, written

G = 9.80665
KMH = 1 / 3.6
ENDED = "the simulation ended after 60 s at 43.2 km/h; raise `simulation.maximum_duration`"
positive = st.floats(0.0, 1e4)


@pytest.fixture
def appendix_b():
    return shipped("uic-541-05-appendix-b")


def by_id(verdicts):
    return {verdict.id: verdict for verdict in verdicts}


def test_a_slip_test_is_judged_by_adhesion_and_slide_but_not_by_distance(appendix_b):
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
    verdicts = by_id(judge(scenario(appendix_b, condition="wet"), stop(), wheelsets(0.01, 0.01, 0.01, 0.01)))
    assert verdicts["initial-adhesion"].status == "not_applicable"
    assert "no wheelset slid" in verdicts["initial-adhesion"].reason
    assert verdicts["minimum-slide"].status == "fail"


def test_a_dry_stop_is_judged_by_distance_alone_and_exactly_at_a_limit_only_a_range_holds(appendix_b):
    verdicts = by_id(judge(scenario(appendix_b), stop(braking_distance=512.0), wheelsets(0.0, 0.0, 0.0, 0.0)))
    assert [v.status for v in verdicts.values()] == ["not_applicable", "not_applicable", "fail"]
    distance = verdicts["braking-distance"]
    assert (distance.lower, distance.upper, distance.margin) == (440.0, 490.0, -22.0)
    assert distance.reason == "512 m misses 440 .. 490 m by 22 m"
    wet = by_id(
        judge(scenario(appendix_b, condition="wet"), sliding_stop(share=0.35), wheelsets(0.9, 0.9, 0.9, 0.9))
    )
    assert wet["minimum-slide"].status == "fail"
    for distance in (440.0, 490.0):
        dry = by_id(judge(scenario(appendix_b), stop(braking_distance=distance), wheelsets(0.0)))
        assert dry["braking-distance"].status == "pass"


WEAK = (
    "no stop at a brake command of 100 % (it is 80 %, tolerance 0 %)",
    "brake command is 80 %, the criterion is for 100 +- 0 %",
)
ANOTHER_TEST = [
    (
        {"position": "G"},
        120,
        "no stop in brake position R (it is G)",
        "brake position is G, the criterion is for R",
    ),
    (
        {},
        124,
        "no stop from 120 km/h (it is 124 km/h, tolerance 3 km/h)",
        "initial speed is 124 km/h, the criterion is for 120 +- 3 km/h",
    ),
    ({"command": 0.8}, 120, *WEAK),
    (
        {"gradient": -0.02},
        120,
        "no stop on a gradient of 0 permille (it is -20 permille, tolerance 1 permille)",
        "gradient is -20 permille, the criterion is for 0 +- 1 permille",
    ),
    (
        {},
        math.nan,
        "no stop from 120 km/h (it is nan km/h, tolerance 3 km/h)",
        "initial speed is nan km/h, the criterion is for 120 +- 3 km/h",
    ),
    (
        {"position": "P", "command": 0.8},
        120,
        f"no stop in brake position R (it is P); {WEAK[0]}",
        f"brake position is P, the criterion is for R; {WEAK[1]}",
    ),
]


@pytest.mark.parametrize(("changes", "speed", "another_test", "reason"), ANOTHER_TEST)
def test_a_stop_of_another_test_is_not_judged_valid_and_a_requirement_says_what_it_is_for(
    appendix_b, changes, speed, another_test, reason
):
    measures = stop(initial_speed=speed * KMH)
    verdict = by_id(judge(scenario(appendix_b, **changes), measures, wheelsets(0.0)))["braking-distance"]
    assert (verdict.status, verdict.reason) == ("inconclusive", another_test)
    assert verdict.sensitivity == ()
    criteria = [each.model_copy(update={"layer": "requirement"}) for each in appendix_b.criteria]
    required = scenario(appendix_b.model_copy(update={"criteria": tuple(criteria)}), **changes)
    verdict = by_id(judge(required, measures, wheelsets(0.0)))["braking-distance"]
    assert (verdict.status, verdict.reason) == ("not_applicable", reason)


def _from(speed, name, criterion, **fields):
    applies = {"initial_speed": {"value": f"{speed} km/h", "tolerance": "3 km/h"}}
    bounds = {"measure": "braking_distance", "lower": "100 m", "upper": "2000 m"}
    return criterion(**{**bounds, "id": name, "applies": applies, **fields})


@pytest.mark.parametrize(
    ("speed", "short", "long", "outcome"),
    [
        (120, "pass", "not_applicable", "pass"),
        (163, "not_applicable", "pass", "pass"),
        (124, "inconclusive", "inconclusive", "inconclusive"),
    ],
)
def test_of_two_criteria_of_validity_for_two_speeds_one_judges_its_own_and_none_another_speed(
    speed, short, long, outcome
):
    two = profile(_from(120, "short", criterion), _from(160, "long", criterion))
    verdicts = by_id(judge(scenario(two), stop(initial_speed=speed * KMH), wheelsets(0.0)))
    assert (verdicts["short"].status, verdicts["long"].status) == (short, long)
    assert outcome_of(verdicts.values())[0] == outcome
    if outcome == "inconclusive":
        assert verdicts["long"].reason == "no stop from 160 km/h (it is 124 km/h, tolerance 3 km/h)"


def test_a_measure_that_no_criterion_of_validity_bounds_is_not_judged_by_one_of_another_measure():
    others = [
        _from(160, "time", criterion, measure="braking_time", lower="1 s", upper="90 s"),
        _from(160, "asked", criterion, layer="requirement"),
        criterion("braking_time", id="always", lower="1 s", upper="90 s"),
    ]
    for other in others:
        two = profile(_from(120, "short", criterion), other)
        verdicts = by_id(judge(scenario(two), stop(initial_speed=160 * KMH), wheelsets(0.0)))
        assert verdicts["short"].status == "inconclusive"
        assert outcome_of(verdicts.values())[0] == "inconclusive"
    # A profile judges by itself: that of another name does not make up for it.
    apart = profile(_from(120, "short", criterion)), profile(_from(160, "long", criterion))
    verdicts = by_id(judge(scenario(*apart), stop(initial_speed=160 * KMH), wheelsets(0.0)))
    assert (verdicts["short"].status, verdicts["long"].status) == ("inconclusive", "pass")


def test_on_another_kind_of_rail_a_criterion_of_validity_does_not_apply_and_says_all_that_keeps_it(
    appendix_b,
):
    other = scenario(appendix_b, position="P", condition="wet")
    verdict = by_id(judge(other, stop(initial_speed=120 * KMH), wheelsets(0.0)))["braking-distance"]
    assert verdict.status == "not_applicable"
    assert verdict.reason == (
        "rail is wet, the criterion is for dry; brake position is P, the criterion is for R"
    )
    assert verdict.sensitivity == ()


@pytest.mark.parametrize(("speed", "distance"), [(117.0, 447.0), (120.0, 470.0), (123.0, 494.0)])
def test_within_the_tolerance_the_distance_is_judged_as_from_120_km_h(appendix_b, speed, distance):
    measures = stop(initial_speed=speed * KMH, braking_distance=distance)
    verdict = by_id(judge(scenario(appendix_b), measures, wheelsets(0.0)))["braking-distance"]
    assert (verdict.status, verdict.value) == ("pass", pytest.approx(470.0, abs=0.4))
    assert "(v0/v)^2" in verdict.definition["correction"]
    assert verdict.definition["nominal_speed"] == "120 km/h (stated)"
    assert (verdict.defined("nominal_speed"), verdict.defined("gradient")) == (120 * KMH, 0.0)


def test_a_criterion_without_a_speed_takes_that_of_the_scenario_or_of_another_criterion_that_is_for_it(
    appendix_b,
):
    own = profile(criterion(upper="490 m"))
    measures = stop(initial_speed=117.0 * KMH, braking_distance=447.0)

    def value(*profiles, **changes):
        return by_id(judge(scenario(*profiles, **changes), measures, wheelsets(0.0)))["tested"].value

    assert value(own, initial_speed="117 km/h") == 447.0
    assert value(own, initial_speed="114 km/h") == pytest.approx(447.0 * (114.0 / 117.0) ** 2)
    assert value(own, appendix_b, initial_speed="117 km/h") == pytest.approx(447.0 * (120.0 / 117.0) ** 2)
    assert value(own, appendix_b, initial_speed="116 km/h") == pytest.approx(447.0 * (116.0 / 117.0) ** 2)


@pytest.mark.parametrize(("gradient", "deceleration"), [(0.03, 0.097), (0.0, 0.067), (-0.03, 0.037)])
def test_uphill_the_weight_has_no_part_in_the_initial_adhesion(appendix_b, gradient, deceleration):
    judged_under = scenario(appendix_b, condition="wet", gradient=gradient)
    stop = sliding_stop(deceleration=deceleration * 9.80665)
    verdict = by_id(judge(judged_under, stop, wheelsets(0.5, 0.5, 0.5, 0.5)))["initial-adhesion"]
    assert (verdict.status, verdict.value) == ("pass", pytest.approx(0.067))


def test_a_train_already_beyond_the_upper_bound_has_failed_before_it_stands():
    bounded = criterion(lower="440 m", upper="490 m")
    running = {"stopped": 0.0, "braking_distance": np.nan, "end_speed": 12.0, "end_time": 60.0}
    far = verdict_of(bounded, stop(**running, end_distance=900.0))
    assert (far.status, far.value, far.margin) == ("fail", 900.0, -410.0)
    assert far.reason == f"900 m so far; {ENDED}"
    near = verdict_of(bounded, stop(**running, end_distance=460.0))
    assert (near.status, near.value, near.margin) == ("inconclusive", None, None)
    assert near.reason == f"460 m so far; {ENDED}"


@pytest.mark.parametrize("measure", ["longest_lock", "locked_time", "sliding_duration"])
def test_a_train_slower_than_the_speed_of_observation_does_not_show_that_no_wheelset_locked(measure):
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
def test_the_wheelset_that_decides_gives_the_value(wheelsets_keep, slides, verdict, value):
    cutoff = {"low_speed_cutoff": {"value": "30 km/h", "range": ["30 km/h", "30 km/h"]}}
    slide = criterion("maximum_slide_above_cutoff", lower="35 %", wheelsets=wheelsets_keep, definition=cutoff)
    found = verdict_of(slide, stop(), wheelsets(*slides))
    assert (found.status, found.value) == (verdict, value)


def test_a_record_of_fewer_wheelsets_than_needed_supports_no_verdict():
    locked = criterion("locked_time", upper="1 s", wheelsets={"at_least": 3})
    found = verdict_of(locked, stop(), wheelsets(0.1, 0.1))
    assert (found.status, found.reason) == ("inconclusive", "the record holds 2 wheelsets")


def test_the_verdict_carries_what_it_was_taken_to_mean_as_text_and_as_data(appendix_b):
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
        "gradient",
    ]
    assert adhesion.defined("moving_speed") == pytest.approx(10 / 3.6)
    assert verdicts["minimum-slide"].defined("end_speed") == pytest.approx(60 / 3.6)


@pytest.mark.parametrize(
    "name", ["braking_distance", "initial_adhesion", "energy_residual", "reservoir_minimum_pressure"]
)
@pytest.mark.parametrize("nan", [math.nan, math.inf, -math.inf])
def test_nan_never_passes(name, nan):
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
def test_a_longer_stop_never_turns_fail_into_pass_under_an_upper_bound(distances, bound):
    limited = criterion(upper=f"{bound:.6f} m")
    shorter, longer = (verdict_of(limited, stop(braking_distance=s)) for s in sorted(distances))
    assert (shorter.status, longer.status) != ("fail", "pass")
    assert shorter.margin >= longer.margin


@given(positive, positive)
def test_the_margin_has_the_sign_of_the_verdict(distance, bound):
    for side in ("lower", "upper"):
        found = verdict_of(criterion(**{side: f"{bound:.6f} m"}), stop(braking_distance=distance))
        assert (found.margin >= 0) == (found.status == "pass")


CONDITIONS = scenarios.TestConditions("soap", "active", "R", 1.0, 0.0, "one-caliper")


@pytest.mark.parametrize(
    ("required", "unmet"),
    [
        ({"rail_condition": ("wet", "soap")}, []),
        ({"rail_condition": ("wet",)}, ["rail is soap, the criterion is for wet"]),
        ({"rail_condition_other_than": ("dry",)}, []),
        ({"rail_condition_other_than": ("dry", "soap")}, ["rail is soap, the criterion is for any other"]),
    ],
)
def test_a_criterion_names_the_rails_it_is_for_or_not_for(required, unmet):
    applies = scenarios.Applicability(**required)
    assert [str(each) for each in scenarios.unmet_conditions(applies, CONDITIONS, None)] == unmet


def test_appendix_b_is_its_three_limits_which_alone_are_marked_as_stated():
    profile = shipped("uic-541-05-appendix-b")
    limits = {
        c.id: (c.measure, c.lower and c.lower.text, c.upper and c.upper.text, c.layer)
        for c in profile.criteria
    }
    assert limits == {
        "initial-adhesion": ("initial_adhesion", None, "0.08 g", "validity"),
        "minimum-slide": ("sliding_share", "35 %", None, "validity"),
        "braking-distance": ("braking_distance", "440 m", "490 m", "validity"),
    }
    stated = {q.text for _, q in quantities_in(profile) if profile.sources[q.source].mark == "stated"}
    assert stated == {"0.08 g", "35 %", "440 m", "490 m", "120 km/h"}
    assert all(source.mark == "chosen" for source in shipped("uictest-stop").sources.values())


@pytest.mark.parametrize("name", ["uic-541-05-appendix-b", "uictest-stop"])
def test_what_is_shipped_has_described_sources_and_the_form_of_its_schema(name):
    profile = shipped(name)
    found = list(quantities_in(profile))
    assert found
    assert all(quantity.source in profile.sources for _, quantity in found)
    assert Criteria.model_validate(profile.model_dump(by_alias=True)) == profile
    jsonschema.validate(written(name), Criteria.model_json_schema())


PHASE = {"first_phase_duration": {"value": "3 s", "range": ["2 s", "5 s"]}}


def cutoff(value="30 km/h", first="10 km/h", last="60 km/h"):
    return {"low_speed_cutoff": {"value": value, "range": [first, last]}}


TIME, DISTANCE = {"measure": "braking_time", "upper": "9 s"}, {"measure": "braking_distance"}
ADHESION = {"measure": "initial_adhesion", "upper": "0.08 g"}
LOCKED = {"measure": "locked_time", "upper": "1 s"}
SLIDE = {"measure": "maximum_slide_above_cutoff", "lower": "35 %", "wheelsets": "all"}


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"measure": "braking_distanc", "upper": "490 m"}, "unknown measure 'braking_distanc'"),
        (DISTANCE, "criterion 'tested' has no bound"),
        (DISTANCE | {"upper": "490 s"}, "unknown unit 's' for a length"),
        (DISTANCE | {"upper": 490}, "'490' has no unit"),
        (DISTANCE | {"upper": ".nan m"}, "not a finite number"),
        (DISTANCE | {"lower": "5 m", "upper": "4 m"}, "lower bound 5 m is above the upper"),
        (DISTANCE | {"upper": "5 m", "wheelsets": "all"}, "a measure of the whole stop"),
        (LOCKED, "'wheelsets' must say how many"),
        (LOCKED | {"wheelsets": {"at_least": 5}}, "less than or equal to 4"),
        (ADHESION, "needs the definition 'first_phase_duration', which is missing"),
        (TIME | {"definition": PHASE}, "does not use the definition 'first_phase_duration'"),
        (SLIDE | {"definition": cutoff("35 km/h")}, "35 km/h is no multiple of 10 km/h"),
        (SLIDE | {"definition": cutoff(last="65 km/h")}, "65 km/h is no multiple of 10 km/h"),
        (SLIDE | {"definition": cutoff(last="300 km/h")}, "out of range"),
        (SLIDE | {"definition": cutoff("70 km/h")}, "outside its own range of 10 km/h to 60 km/h"),
        (SLIDE | {"definition": cutoff("60 km/h", "60 km/h", "10 km/h")}, "falls from 60 km/h to 10 km/h"),
        (TIME | {"id": "No Blanks"}, "should match pattern"),
        (TIME | {"layer": "maybe"}, "'validity' or 'requirement'"),
        (TIME | {"upper": {"value": "9 s", "source": "nowhere"}}, "unknown source 'nowhere'"),
        (TIME | {"source": "nowhere"}, "unknown source 'nowhere'"),
    ],
)
def test_what_makes_no_criterion_is_refused(fields, message):
    whole = {"id": "tested", "layer": "validity", **fields}
    with pytest.raises(ValidationError, match=message.replace("(", r"\(")):
        Criteria.model_validate({"name": "mine", "criteria": [whole]})


def test_a_mistyped_measure_is_answered_with_the_nearest():
    wrong = {"id": "a", "layer": "validity", "measure": "braking_distanc", "upper": "490 m"}
    with pytest.raises(ValidationError) as caught:
        Criteria.model_validate({"criteria": [wrong]})
    (error,) = caught.value.errors()
    assert (error["ctx"]["hint"], error["loc"][1:]) == ("did you mean 'braking_distance'?", (0, "measure"))


def test_a_profile_of_another_kind_without_criteria_or_with_two_of_a_name_is_refused():
    one = {"id": "same", "layer": "validity", "measure": "standstill", "lower": 1}
    with pytest.raises(ValidationError, match="a second criterion is called 'same'"):
        Criteria.model_validate({"criteria": [one, one]})
    with pytest.raises(ValidationError, match="uictest/criteria/1"):
        Criteria.model_validate({"schema": "uictest/rail/1", "criteria": [one]})
    with pytest.raises(ValidationError, match="the profile has no criterion"):
        Criteria.model_validate({"criteria": []})
