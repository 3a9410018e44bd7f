"""Series judged from results that are written down: what counts, what decides, and how sure it is."""

import json
import math
from dataclasses import replace

import pytest

from uictest.judging import evaluation, series
from uictest.plans.scenario import PASS, expectation_of
from uictest.plans.scenario.yaml import parse_quantity
from uictest.report.series_report import bypassed_is_better, series_verdict_sentence

from .conftest import PAIR, judge, no_test

THREE = "dry: dry.yaml\nwet: {scenario: wet.yaml, set: {rail.friction: [0.07, 0.08, 0.09]}}\n"
CRITERIA = "schema: uictest/criteria/1\nname: own\ncriteria: [{%s}]\n"
OWN = """schema: uictest/criteria/1
name: own
criteria:
  - {id: k-wet, layer: requirement, scope: series, measure: k_wet, lower: 0.80}
  - {id: each, layer: requirement, measure: braking_distance, upper: 130 % of the dry stop}
  - {id: passing, layer: requirement, scope: series, measure: passing_share, lower: 60 %}
"""


@pytest.fixture
def judged_by(load, write):
    """The series of a file that says this, judged by criteria in a file of their own."""

    def read(own=OWN, text=PAIR):
        write("own.yaml", own)
        (one,) = load(f"{text}criteria: own.yaml\n")
        return one

    return read


@pytest.fixture
def planned(judged_by):
    """One dry stop and three wet ones, judged by three criteria."""
    return judged_by(OWN, THREE)


def verdicts(result):
    return {each.verdict.id: each for each in result.criteria}


def test_a_series_that_keeps_everything_passes_and_a_miss_says_how_much_is_missing(planned):
    result = judge(planned, [460.0, 500.0, 520.0, 540.0])
    assert (result.outcome, result.met) == ("pass", True)
    k_wet = verdicts(result)["k-wet"]
    # Deceleration distances 440, 460, 480 m against 400 m: 15 % more in the mean.
    assert k_wet.verdict.value == pytest.approx(100.0 / 115.0)
    assert k_wet.verdict.margin == pytest.approx(100.0 / 115.0 - 0.8)
    assert k_wet.speed_kmh == 120.0
    # Deceleration distances 600, 640 and 680 m against 400 m.
    k_wet = verdicts(judge(planned, [460.0, 660.0, 700.0, 740.0]))["k-wet"].verdict
    assert (k_wet.status, k_wet.reason) == ("fail", "0.625 from 120 km/h misses >= 0.8 by 0.175")
    certain = judge(planned, [[459.9, 460.1], 519.0, 520.0, 521.0])
    uncertain = judge(planned, [[459.9, 460.1], 480.0, 520.0, 560.0])
    assert verdicts(certain)["k-wet"].confident is True
    assert verdicts(uncertain)["k-wet"].confident is False
    assert uncertain.outcome == "pass"
    # The wet stops of the first, beside dry ones that scatter by 5 %.
    assert verdicts(judge(planned, [[444.0, 476.0], 519.0, 520.0, 521.0]))["k-wet"].confident is False
    # One dry stop shows no scatter, nor do two equal ones.
    alone = verdicts(judge(planned, [460.0, 519.0, 520.0, 521.0]))["k-wet"]
    assert (alone.verdict.status, alone.confident) == ("pass", False)
    assert verdicts(judge(planned, [[460.0, 460.0], 519.0, 520.0, 521.0]))["k-wet"].confident is False
    assert "no 95 % interval: one dry stop shows no scatter" in series_verdict_sentence(alone, 0.95)


def test_one_stop_from_each_speed_has_a_speed_that_decides(judged_by):
    speeds = "set: {initial_speed: [80 km/h, 120 km/h]}"
    dry, wet = (f"{{scenario: {role}.yaml, {speeds}}}" for role in ("dry", "wet"))
    one = judged_by(OWN, f"dry: {dry}\nwet: {wet}\n")
    # Deceleration distances of 160 and 400 m grow by 12.5 and by 25 %.
    k_wet = verdicts(judge(one, [220.0, 460.0, 240.0, 560.0]))["k-wet"]
    assert (k_wet.verdict.value, k_wet.speed_kmh) == (pytest.approx(0.8), 120.0)


def test_a_share_of_a_dry_figure_of_zero_names_the_dry_stops(judged_by):
    share = "id: locks, layer: requirement, scope: series, measure: worst_locked_time"
    one = judged_by(CRITERIA % f"{share}, upper: 150 % of the dry stop")
    locks = verdicts(judge(one, [460.0, 500.0]))["locks"].verdict
    assert (locks.status, locks.reason) == ("inconclusive", "the dry stops have no such number above zero")


def test_every_wet_stop_must_keep_a_criterion_of_stops_and_passes_only_within_its_share(planned):
    result = judge(planned, [460.0, 500.0, 520.0, 600.0])
    each = verdicts(result)["each"]
    assert (each.verdict.status, each.kept, each.stops) == ("fail", 2, 3)
    # The worst stop decides: 600 m is 130.43 % of 460 m.
    assert each.verdict.value == pytest.approx(100.0 * 600.0 / 460.0)
    assert each.of_dry_stop
    result = judge(planned, [460.0, 500.0, 600.0, 610.0])
    share = verdicts(result)["passing"]
    assert share.verdict.value == pytest.approx(100.0 / 3.0)
    assert share.verdict.status == "fail"
    result = judge(planned, [460.0, 500.0, 520.0, 540.0], {500.0: "fail"})
    assert result.speeds[0].wet.counted == 3
    assert verdicts(result)["passing"].verdict.value == pytest.approx(200.0 / 3.0)


def test_invalid_stops_do_not_count_and_are_named(planned):
    # The invalid stop of 2000 m would spoil every figure.
    planned = _with_valid_share(planned, "60 %")
    result = judge(planned, [460.0, 500.0, 520.0, 2000.0], {2000.0: "invalid"})
    (speed,) = result.speeds
    assert (speed.wet.run, speed.wet.counted) == (3, 2)
    assert verdicts(result)["k-wet"].verdict.value == pytest.approx(100.0 / 112.5)
    assert [(stop.case, stop.outcome, stop.reason) for stop in result.not_counted] == [
        ("campaign.wet[friction=0.09]", "invalid", "slippery: because it is invalid")
    ]


LOCKED = evaluation.Verdict("locked", "requirement", 5.0, "s", None, 1.0, -4.0, "fail", "5 s")
UNDECIDED = evaluation.Verdict(
    "slippery", "validity", None, "g", None, 0.08, None, "inconclusive", "no channel"
)
GRIP = evaluation.Verdict("grip", "rig", 2.0, "1", None, 1.0, -1.0, "fail", "slips")


@pytest.mark.parametrize(
    ("criteria", "counts"),
    [
        ((LOCKED,), None),
        ((LOCKED, no_test("0.09 g")), ("invalid", "slippery: 0.09 g")),
        ((no_test("0.09 g"),), ("invalid", "slippery: 0.09 g")),
        ((LOCKED, UNDECIDED), ("inconclusive", "slippery: no channel")),
        ((LOCKED, GRIP), ("invalid", "grip: slips")),
        ((replace(LOCKED, status="inconclusive"),), None),
    ],
)
def test_validity_says_whether_a_stop_counts_and_the_outcome_does_not(planned, criteria, counts):
    planned = _with_valid_share(planned, "60 %")
    *others, last = judge(planned, [460.0, 500.0, 520.0, 2000.0]).cases
    outcome, reason = evaluation.outcome_of(criteria)
    case = replace(last.case, outcome=outcome, reason=reason, criteria=criteria)
    result = series.judge_series(planned, [*others, replace(last, case=case)])
    found = [(stop.outcome, stop.reason) for stop in result.not_counted]
    assert found == ([] if counts is None else [counts])
    assert result.speeds[0].wet.counted == (3 if counts is None else 2)
    # A stop that counts is in every figure, one that passes is all the same no test.
    k_wet = verdicts(result)["k-wet"].verdict.value
    mean = (440.0 + 460.0 + 1940.0) / 3.0 if counts is None else 450.0
    assert k_wet == pytest.approx(400.0 / mean)


def test_of_a_stop_that_leaves_a_requirement_open_it_is_not_known_whether_it_passes(planned):
    *others, last = judge(planned, [460.0, 500.0, 520.0, 540.0]).cases
    left_open = (replace(LOCKED, status="inconclusive"),)
    case = replace(last.case, outcome="inconclusive", reason="locked: 5 s", criteria=left_open)
    result = series.judge_series(planned, [*others, replace(last, case=case)])
    assert result.speeds[0].wet.counted == 3
    assert result.speeds[0].measures["passing_share"].estimate is None
    # Its distance is known: K_wet is.
    assert result.speeds[0].measures["k_wet"].estimate is not None
    # One that was not seen to its end is in no figure.
    unseen = replace(case, measures={**case.measures, "braking_distance_m": math.nan})
    result = series.judge_series(planned, [*others, replace(last, case=unseen)])
    assert [(stop.outcome, stop.reason) for stop in result.not_counted] == [("inconclusive", "locked: 5 s")]


@pytest.mark.parametrize("outcome", ["invalid", "skipped"])
def test_too_few_stops_that_count_decide_nothing(planned, outcome):
    result = judge(planned, [460.0, 500.0, 520.0, 540.0], {540.0: outcome})
    assert result.outcome == "inconclusive"
    assert {each.verdict.status for each in result.criteria} == {"inconclusive"}
    assert "2 of 3 wet stops from 120 km/h count, 80 % must" in result.reason


def test_without_a_dry_stop_that_counts_nothing_is_decided_and_one_that_failed_to_run_is_an_error(planned):
    result = judge(planned, [460.0, 500.0, 520.0, 540.0], {460.0: "invalid"})
    assert result.outcome == "inconclusive"
    assert "none of 1 dry stops from 120 km/h counts" in result.reason
    assert judge(planned, [460.0, 500.0, 520.0, 540.0], {500.0: "error"}).outcome == "error"
    without_wet = series.judge_series(planned, result.cases[:1])
    assert "0 of 0 wet stops from 120 km/h count" in without_wet.reason


def test_a_criterion_of_stops_is_judged_by_the_verdicts_of_those_that_count(judged_by):
    over = _locks(judged_by, {})
    assert (over.verdict.status, over.verdict.value, over.kept, over.stops) == ("fail", 2.5, 2, 3)
    over = _locks(judged_by, {2.5: "invalid"})
    assert (over.verdict.status, over.verdict.value, over.kept, over.stops) == ("pass", 0.5, 2, 2)
    # The stop counts, as it fails by something else.
    over = _locks(judged_by, {2.5: "fail"}, {2.5: "inconclusive"})
    assert (over.verdict.status, over.kept, over.stops) == ("inconclusive", 2, 3)
    assert over.verdict.reason == "2 of 3 stops keep it"
    one = _locks(judged_by, {2.5: "pass"}, {2.5: "not_applicable"})
    assert (one.verdict.status, one.kept, one.stops) == ("pass", 2, 2)
    none = _locks(judged_by, {2.5: "pass"}, dict.fromkeys((0.0, 0.5, 2.5), "not_applicable"))
    assert (none.verdict.status, none.verdict.value) == ("not_applicable", None)
    assert none.verdict.reason == "it applies to none of the stops that count"


def _locks(judged_by, outcomes, statuses=None):
    """The verdict over a dry and two wet stops whose wheels lock for 0, 0.5 and 2.5 s."""
    criterion = "id: locks, layer: requirement, measure: longest_lock, wheelsets: all, upper: 1 s"
    wet = "{scenario: wet.yaml, set: {rail.friction: [0.07, 0.08]}}"
    planned = judged_by(CRITERIA % criterion, f"dry: dry.yaml\nwet: {wet}\nvalid_stops: 50 %\n")
    cases = []
    for each, longest in zip(judge(planned, [460.0, 500.0, 510.0]).cases, (0.0, 0.5, 2.5), strict=True):
        status = (statuses or {}).get(longest, "pass" if longest <= 1.0 else "fail")
        verdict = evaluation.Verdict(
            "locks", "requirement", longest, "s", None, 1.0, 1.0 - longest, status, ""
        )
        outcome = outcomes.get(longest, "pass" if longest <= 1.0 else "fail")
        criteria = (verdict, no_test("made up")) if outcome == "invalid" else (verdict,)
        case = replace(each.case, criteria=criteria, outcome=outcome, repeats=None)
        cases.append(replace(each, case=case))
    (over,) = series.judge_series(planned, cases).criteria
    return over


def test_every_repeat_is_a_stop_and_the_dry_stop_the_mean_of_those_that_count(judged_by):
    planned = judged_by()
    distances = [500.0, 505.0, 510.0, 515.0, 520.0, 525.0]
    result = judge(planned, [[459.0, 461.0], distances])
    estimate = result.measures["median_braking_distance"].estimate
    assert (estimate.value, estimate.low, estimate.high, estimate.stops) == (512.5, 500.0, 525.0, 6)
    assert result.speeds[0].dry == series.StopCounts(2, 2)
    result = judge(planned, [[450.0, 470.0, 900.0], [552.0]], {900.0: "invalid"})
    assert verdicts(result)["each"].verdict.value == pytest.approx(100.0 * 552.0 / 460.0)
    dry, wet = (each.case for each in judge(planned, [460.0, 500.0]).cases)
    measures = dict(wet.measures or {}) | {"mean_deceleration_mps2": (115.0 / 3.6) ** 2 / 1000.0}
    slower = evaluation.CaseResult(wet.id, "x", {}, PASS, "pass", measures=measures)
    result = series.judge_series(
        planned, [series.SeriesCase("dry", 120.0, dry), series.SeriesCase("wet", 120.0, slower)]
    )
    assert result.not_counted[0].reason == "initial speed is 115 km/h, nominal 120 +- 3 km/h"


def test_the_requirements_of_a_series_and_of_its_criteria_are_kept_where_there_are_any(judged_by, planned):
    (form,) = series.series_document([judge(planned, [460.0, 500.0, 520.0, 540.0])])["series"]
    assert not {"requirements", "test_case"} & form.keys()
    assert not any("requirements" in each["verdict"] for each in form["criteria"])
    own = OWN.replace("lower: 0.80}", "lower: 0.80, requirements: [BR-WSP-12]}")
    named = judged_by(own, f"{PAIR}requirements: [BR-9, BR-1]\ntest_case: WSP-TC-7\n")
    document = json.loads(json.dumps(series.series_document([judge(named, [460.0, 500.0])])))
    (read,) = series.series_results_of(document)
    assert (read.requirements, read.test_case) == (("BR-9", "BR-1"), "WSP-TC-7")
    assert document["series"][0]["requirements"] == ["BR-9", "BR-1"]
    assert verdicts(read)["k-wet"].verdict.requirements == ("BR-WSP-12",)


def test_expected_failures_are_met(judged_by):
    planned = judged_by(OWN, f"{PAIR}expect: fail\n")
    assert judge(planned, [460.0, 900.0]).met
    assert not judge(planned, [460.0, 500.0]).met


def test_a_series_is_judged_again_from_its_document_but_not_by_another_series(planned, load):
    result = judge(_with_valid_share(planned, "60 %"), [460.0, 500.0, 520.0, 540.0], {540.0: "invalid"})
    document = json.loads(json.dumps(series.series_document([result])))
    (read,) = series.series_results_of(document)
    assert json.dumps(series.series_document([read])) == json.dumps(document)
    again = series.judge_series(_with_valid_share(planned, "60 %"), read.cases)
    assert json.dumps(series.series_document([again])) == json.dumps(document)
    (other,) = load()
    with pytest.raises(ValueError, match="has no case"):
        series.judge_series(other, result.cases)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda document: document.update(more=1), "expected the fields"),
        (
            lambda document: document["series"][0]["measures"].update(
                new=document["series"][0]["measures"]["k_wet"]
            ),
            "no series has a measure 'new'",
        ),
        (lambda document: document["series"][0]["criteria"][1].update(kept=99), "99 of 3 stops keep 'each'"),
        (lambda document: document["series"][0].update(outcome="good"), "series.0.outcome"),
        (lambda document: document["series"][0].pop("confidence"), "series.0.confidence"),
        (lambda document: document["series"][0]["cases"][0].update(case="other"), "no case 'other'"),
        (lambda document: document["series"][0]["speeds"][0].update(speed="x"), "series.0.speeds.0.speed"),
        (lambda document: document["cases"].append(document["cases"][0]), "same id"),
        (lambda document: document["cases"][0].update(outcome=3), "series.cases.0.outcome"),
    ],
)
def test_a_document_that_is_none_is_refused(planned, spoil, message):
    document = json.loads(json.dumps(series.series_document([judge(planned, [460.0, 500.0, 520.0, 540.0])])))
    spoil(document)
    with pytest.raises(ValueError, match=message):
        series.series_results_of(document)


def _with_valid_share(planned, text):
    share = parse_quantity(text, "share")
    return replace(planned, file=planned.file.model_copy(update={"valid_stops": share}))


TWO_SPEEDS = "{role}: {{scenario: {role}.yaml, set: {{initial_speed: [80 km/h, 120 km/h]}}{more}}}\n"


@pytest.fixture
def two_speeds(judged_by):
    """Dry and wet stops from two speeds, the wet ones repeated, by a bound above and one below."""
    own = "layer: requirement, scope: series, measure: median_braking_distance"
    long = f"id: long, {own}, upper: 130 % of the dry stop"
    short = f"id: short, {own}, lower: 105 % of the dry stop"
    wet = TWO_SPEEDS.format(role="wet", more=", repeat: 7")
    dry = TWO_SPEEDS.format(role="dry", more=", repeat: 2")
    return judged_by(CRITERIA % f"{long}}}, {{{short}", dry + wet)


def test_every_bound_is_judged_at_the_speed_nearest_to_missing_it(two_speeds):
    result = verdicts(judge(two_speeds, [200.0, 400.0, [202.0] * 7, [500.0] * 7]))
    assert (result["long"].verdict.status, result["long"].speed_kmh) == ("pass", 120.0)
    assert (result["short"].verdict.status, result["short"].speed_kmh) == ("fail", 80.0)
    assert result["short"].verdict.value == pytest.approx(101.0)


def test_a_verdict_is_as_certain_as_its_least_certain_speed_and_a_miss_as_the_most_certain_one(two_speeds):
    # From 80 km/h the median is 115 % but may lie at 140 %; that from 120 km/h is 125 % for certain.
    scattered = [214.0, 216.0, 218.0, 230.0, 270.0, 275.0, 280.0]
    long = verdicts(judge(two_speeds, [[199.99, 200.01], [399.99, 400.01], scattered, [500.0] * 7]))["long"]
    assert (long.verdict.status, long.speed_kmh, long.confident) == ("pass", 120.0, False)
    scattered = [240.0, 242.0, 244.0, 280.0, 282.0, 284.0, 286.0]
    long = verdicts(judge(two_speeds, [[199.99, 200.01], [399.99, 400.01], scattered, [540.0] * 7]))["long"]
    assert (long.verdict.status, long.speed_kmh, long.confident) == ("fail", 80.0, True)


def test_the_scatter_of_dry_stops_can_make_the_largest_value_uncertain_and_never_certain(judged_by):
    longest = "id: longest, layer: requirement, scope: series, measure: worst_braking_distance"
    own = CRITERIA % f"{longest}, upper: 125 % of the dry stop"
    one = judged_by(own, "dry: {scenario: dry.yaml, repeat: 2}\nwet: wet.yaml\n")

    def certain(dry, wet):
        each = verdicts(judge(one, [dry, wet]))["longest"]
        return each.verdict.status, each.confident

    # One wet stop of 120 % and of 130 % of 400 m; t for two dry stops is 12.7.
    assert certain([399.99, 400.01], 480.0) == ("pass", None)
    assert certain([396.0, 404.0], 480.0) == ("pass", False)
    assert certain([399.99, 400.01], 520.0) == ("fail", True)
    assert certain([396.0, 404.0], 520.0) == ("fail", False)


BOTH_RAILS = """\
dry: dry.yaml
wet:
  - {scenario: wet.yaml, set: {rail.condition: wet-cleaning, rail.friction: 0.08, seed: [0, 1]}}
  - {scenario: wet.yaml, set: {seed: [2, 3]}}
"""
RAILS = """\
schema: uictest/criteria/1
name: rails
criteria:
  - {id: k-wet, layer: requirement, scope: series, measure: k_wet, lower: 0.8, applies: {rail_cleaned: true}}
  - {id: longest, layer: requirement, scope: series, measure: worst_braking_distance,
     upper: 150 % of the dry stop}
  - {id: share, layer: requirement, scope: series, measure: passing_share, lower: 50 %}
"""


def test_stops_on_different_rails_are_judged_apart(judged_by):
    planned = judged_by(RAILS, BOTH_RAILS)
    result = judge(planned, [460.0, 500.0, 510.0, 900.0, 910.0], {900.0: "fail", 910.0: "fail"}, 480.0)
    verdicts = {each.verdict.id: each for each in result.criteria}
    assert (verdicts["k-wet"].verdict.status, verdicts["k-wet"].rail) == ("pass", "cleaned")
    assert verdicts["k-wet"].verdict.value == pytest.approx(400.0 / 445.0)
    assert (verdicts["longest"].verdict.status, verdicts["longest"].rail) == ("fail", "uncleaned")
    # Half of all stops pass, and none of those on the rail that is not cleaned.
    assert (verdicts["share"].verdict.value, verdicts["share"].rail) == (0.0, "uncleaned")
    extensions = {each.rail: each.measures["stopping_distance_extension"] for each in result.speeds}
    assert extensions["cleaned"].estimate.value == pytest.approx(100.0 * 45.0 / 460.0)
    assert extensions["uncleaned"].estimate.value == pytest.approx(100.0 * 445.0 / 460.0)
    shares = {each.rail: each.measures["passing_share"].estimate for each in result.speeds}
    assert {rail: (each.value, each.stops) for rail, each in shares.items()} == {
        "cleaned": (100.0, 2),
        "uncleaned": (0.0, 2),
    }
    # Of several rails together nothing is stated, in no format: a terminal, JSON, CSV and the page read this.
    assert {name for name, each in result.measures.items() if each.estimate is not None} == set()


def test_k_wet_of_the_bypassed_wsp_stands_beside_and_decides_nothing(judged_by):
    # A second criterion of K_wet does not count the stops twice.
    k_wet = RAILS.splitlines(keepends=True)[3]
    planned = judged_by(RAILS + k_wet.replace("id: k-wet", "id: again"), BOTH_RAILS)
    assert [stop.role for stop in planned.stops] == ["dry", *["wet"] * 4, *["bypassed"] * 2]
    assert {stop.case.scenario.rig.wsp for stop in planned.stops[5:]} == {"bypassed"}
    # Wheels lock: that they miss the criteria is what is expected, and no reason to keep their recordings.
    assert {str(stop.case.scenario.expect) for stop in planned.stops[5:]} == {"fail"}
    distances = [[459.99, 460.01], 500.0, 510.0, 600.0, 610.0]
    better, without = judge(planned, distances, {480.0: "fail"}, 480.0), judge(planned, distances)
    estimate = better.bypassed_k_wet.estimate
    assert (estimate.value, estimate.stops) == (pytest.approx(400.0 / 420.0), 2)
    assert (better.criteria, better.speeds, better.outcome) == (
        *(without.criteria, without.speeds, without.outcome),
    )
    said = bypassed_is_better(better)
    assert "K_wet is better with the WSP bypassed, 0.9524" in said
    assert "wheelsets lock for up to 0 s with it bypassed, 0 s with the tested WSP" in said
    worse = judge(planned, distances, bypassed=700.0)
    assert bypassed_is_better(worse) == ""
    (read,) = series.series_results_of(series.series_document([better]))
    assert read == better


def test_a_criterion_that_no_wet_stop_is_for_decides_nothing_and_no_judgement_is_not_met(judged_by):
    planned = judged_by(RAILS)
    assert [stop.role for stop in planned.stops] == ["dry", "wet"]
    k_wet = judge(planned, [460.0, 500.0]).criteria[0].verdict
    assert (k_wet.status, k_wet.reason) == ("not_applicable", "it applies to none of the wet stops")
    result = judge(judged_by("\n".join(RAILS.splitlines()[:4])), [460.0, 500.0])
    assert (result.outcome, result.met) == ("skipped", False)
    assert replace(result, expect=expectation_of("skipped")).met
