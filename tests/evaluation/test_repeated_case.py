"""What the stops of a repeated case come to: by hand, and for a case."""

from collections import Counter
from dataclasses import replace
from statistics import median

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.judging.evaluation import (
    CaseResult,
    Repeats,
    SimulatedRepeat,
    Verdict,
    error_result,
    evaluate,
    evaluate_repeats,
    outcome_of,
)
from uictest.judging.evaluation.decision import Bounds, Decision
from uictest.judging.evaluation.repeated_case import (
    OutcomeRule,
    decision_over_stops,
    outcome_over_stops,
    over_stops,
)
from uictest.judging.evaluation.repeats import RepeatedStop, seeds_text
from uictest.plans.scenario import PASS, ShareOfStops, expectation_of

from ..measures.catalogue.conftest import sliding_stop, stop, wheelsets
from .conftest import case, criterion, evaluate_stops, profile, scenario

ALL, MEDIAN = OutcomeRule("all"), OutcomeRule("median")
LETTERS = {"p": "pass", "f": "fail", "i": "invalid", "u": "inconclusive", "s": "skipped", "e": "error"}
DISTANCE = Bounds(440.0, 490.0, unit="m")


def at_least(share):
    return OutcomeRule("at_least", share)


def stops(letters):
    return [RepeatedStop(seed, LETTERS[letter], f"why {seed}") for seed, letter in enumerate(letters)]


def outcome(letters, expect, rule):
    return outcome_over_stops(stops(letters), expectation_of(expect), rule, ("pass", ""))[0]


@pytest.mark.parametrize(
    ("letters", "expect", "came_out"),
    [
        ("ppp", "pass", "pass"),
        ("pps", "pass", "skipped"),
        ("sss", "skipped", "skipped"),
        ("ssp", "skipped", "pass"),
        ("sss", "pass", "skipped"),
        ("ppf", "pass", "fail"),
        ("ppi", "pass", "invalid"),
        ("pfi", "pass", "fail"),  # a valid stop that fails says more than one that is no test
        ("ppu", "pass", "inconclusive"),
        ("puf", "pass", "fail"),
        ("fff", "fail", "fail"),
        ("ffp", "fail", "pass"),
        ("ffi", "fail", "invalid"),
        ("fpi", "fail", "pass"),
        ("ffs", "fail", "skipped"),
        ("ffu", "fail", "inconclusive"),
        ("iii", "invalid", "invalid"),
        ("iip", "invalid", "pass"),
        ("iif", "invalid", "fail"),
        ("ipf", "invalid", "fail"),
        ("ppe", "pass", "error"),
        ("ffe", "fail", "error"),
    ],
)
def test_all_stops_must_come_out_as_expected(letters, expect, came_out):
    assert outcome(letters, expect, ALL) == came_out
    # The order of the seeds says nothing.
    assert outcome(letters[::-1], expect, ALL) == came_out


@pytest.mark.parametrize(
    ("letters", "expect", "share", "came_out"),
    [
        ("pppppppppf", "pass", 0.9, "pass"),
        ("ppppppppff", "pass", 0.9, "fail"),
        ("ppppppppfu", "pass", 0.9, "inconclusive"),  # the undecided stop could be the ninth
        ("pppppppffu", "pass", 0.9, "fail"),
        ("pppppppppi", "pass", 0.9, "pass"),
        ("ppppppppii", "pass", 0.9, "invalid"),
        ("pf", "pass", 0.5, "pass"),
        ("pf", "pass", 0.51, "fail"),
        ("fffffffffp", "fail", 0.9, "fail"),
        ("ffffffffpp", "fail", 0.9, "pass"),
        ("pppppppppe", "pass", 0.1, "error"),  # an error never vanishes
        ("ppp", "pass", 1.0, "pass"),
    ],
)
def test_a_share_of_the_stops_must_come_out_as_expected(letters, expect, share, came_out):
    assert outcome(letters, expect, at_least(share)) == came_out


def test_the_reason_names_the_stops_and_the_median_takes_the_outcome_of_its_verdicts_but_errors():
    reason = outcome_over_stops(stops("fpfpfffi"), PASS, ALL, ("pass", ""))[1]
    assert reason == (
        "fail in 5 of 8 stops (seeds 0, 2, 4..6), with seed 0: why 0;"
        " invalid in 1 of 8 stops (seed 7), with seed 7: why 7"
    )
    assert outcome_over_stops(stops("ppp"), PASS, ALL, ("pass", "")) == ("pass", "")
    assert outcome_over_stops(stops("fff"), PASS, MEDIAN, ("pass", "")) == ("pass", "")
    assert outcome_over_stops(stops("pep"), PASS, MEDIAN, ("pass", "")) == (
        "error",
        "error in 1 of 3 stops (seed 1), with seed 1: why 1",
    )


@given(
    letters=st.text("pfius", min_size=1, max_size=12),
    expect=st.sampled_from(("pass", "fail", "invalid", "skipped")),
    share=st.floats(0.01, 1.0),
)
def test_as_expected_if_and_only_if_enough_stops_are(letters, expect, share):
    counts = Counter(LETTERS[letter] for letter in letters)
    came_out = outcome(letters, expect, at_least(share))
    assert (came_out == expect) == (counts[expect] >= share * len(letters) - 1e-9)
    assert came_out in counts or came_out == "inconclusive"
    assert outcome(letters, expect, at_least(1.0)) == outcome(letters, expect, ALL)


@given(letters=st.text("pfius", min_size=1, max_size=12), data=st.data())
def test_the_order_of_the_stops_does_not_matter(letters, data):
    shuffled = "".join(data.draw(st.permutations(letters)))
    rule = at_least(data.draw(st.floats(0.01, 1.0)))
    assert outcome(letters, "pass", rule) == outcome(shuffled, "pass", rule)


def test_nine_of_ten_are_ninety_per_cent_whatever_binary_makes_of_it():
    for stops_needed in range(1, 101):
        assert OutcomeRule("at_least", stops_needed / 100).needed(100) == stops_needed
    assert OutcomeRule("at_least", 0.1 + 0.2).needed(10) == 3


def decided(value, status=""):
    if status:
        return Decision(status, value, "made up")
    assert value is not None
    return Decision("pass" if DISTANCE.hold(value) else "fail", value, "")


def together(decisions, rule):
    return decision_over_stops(decisions, DISTANCE, rule)


def test_a_criterion_has_the_median_and_counts_and_is_judged_by_the_rule():
    values = [450.0, 460.0, 495.0]
    decisions = [decided(value) for value in values]
    assert [together(decisions, rule).status for rule in (ALL, MEDIAN, at_least(0.6), at_least(0.7))] == [
        *("fail", "pass", "pass", "fail")
    ]
    assert together(decisions, ALL).value == 460.0
    assert together(decisions, ALL).reason == (
        "2 of 3 stops pass (3 needed): median 460 in 450 .. 495, against 440 .. 490 m"
    )
    assert together(decisions, MEDIAN).reason.startswith("2 of 3 stops pass: median")
    counts = over_stops([decided(450.0), decided(495.0), decided(None, "not_applicable")])
    assert (counts.passed, counts.failed, counts.not_applicable, counts.stops) == (1, 1, 1, 3)
    assert (counts.lowest, counts.highest) == (450.0, 495.0)
    assert counts.turns
    assert not over_stops([decided(450.0), decided(460.0)]).turns


def test_stops_that_a_criterion_does_not_apply_to_do_not_count_and_where_all_agree_so_does_the_median():
    skipped = decided(None, "not_applicable")
    both = together([decided(450.0), skipped, decided(460.0)], ALL)
    assert (both.status, both.value) == ("pass", 455.0)
    assert both.reason.startswith("2 of 2 stops pass (2 needed), not applicable to 1 more: ")
    assert together([skipped, skipped], ALL) == skipped
    # Two stops too short and two too long have a median inside the limits, and still all fail.
    decisions = [decided(value) for value in (400.0, 410.0, 520.0, 530.0)]
    assert together(decisions, MEDIAN).value == 465.0
    assert together(decisions, MEDIAN).status == "fail"


@pytest.mark.parametrize(
    ("known", "unknown", "status"),
    [
        ([450.0, 460.0, 470.0, 480.0, 485.0], 1, "pass"),  # the median lies between 455 and 482.5 at worst
        ([445.0, 460.0, 486.0, 495.0], 1, "pass"),  # between 460 and 486
        ([445.0, 460.0, 492.0, 495.0], 1, "inconclusive"),  # between 460 and 492
        ([495.0, 500.0, 505.0, 460.0], 1, "fail"),
        ([495.0, 500.0, 505.0, 510.0, 460.0], 1, "fail"),
        ([450.0], 2, "inconclusive"),
    ],
)
def test_a_stop_without_a_value_may_have_any_value_in_the_median(known, unknown, status):
    decisions = [*map(decided, known), *[decided(None, "inconclusive")] * unknown]
    assert together(decisions, MEDIAN).status == status
    assert together(decisions, MEDIAN).reason.endswith("; made up")


@given(
    values=st.lists(st.floats(400.0, 530.0), min_size=1, max_size=9),
    unknown=st.integers(0, 4),
    fillings=st.lists(st.floats(-1e6, 1e6), min_size=4, max_size=4),
)
def test_a_decided_median_stays_whatever_the_unknown_values_are(values, unknown, fillings):
    decisions = [*map(decided, values), *[decided(None, "inconclusive")] * unknown]
    verdict = together(decisions, MEDIAN)
    filled = [*values, *fillings[:unknown]]
    if verdict.status == "inconclusive" or len({decided(each).status for each in filled}) == 1:
        return
    assert (verdict.status == "pass") == DISTANCE.hold(median(filled))


@pytest.mark.parametrize(
    ("statuses", "share", "status"),
    [
        (["pass", "pass", "inconclusive"], 1.0, "inconclusive"),
        (["pass", "pass", "inconclusive"], 0.6, "pass"),
        (["pass", "fail", "inconclusive"], 1.0, "fail"),
        (["pass", "fail", "inconclusive"], 0.6, "inconclusive"),
    ],
)
def test_inconclusive_stops_decide_only_where_they_could_make_up_the_number(statuses, share, status):
    value = {"pass": 450.0, "fail": 500.0, "inconclusive": None}
    decisions = [decided(value[each], each) for each in statuses]
    assert together(decisions, at_least(share)).status == status


@pytest.mark.parametrize(
    ("seeds", "text"),
    [
        ([3], "seed 3"),
        ([3, 4], "seeds 3, 4"),
        ([3, 4, 5], "seeds 3..5"),
        ([0, 2, 3, 4, 9], "seeds 0, 2..4, 9"),
        (list(range(0, 20, 2)), "seeds 0, 2, 4, 6, 8, 10 and 4 more"),
    ],
)
def test_seeds_for_a_reader(seeds, text):
    assert seeds_text(seeds) == text


def missing(seed, names):
    """A stop that misses the requirements with these names, of `a` and `b`."""
    verdicts = [
        Verdict(name, "requirement", 2.0, "s", None, 1.0, -1.0, "fail" if name in names else "pass", "2 s")
        for name in "ab"
    ]
    outcome, reason = outcome_of(verdicts)
    return RepeatedStop(seed, outcome, reason, tuple(verdicts))


def came_out(stops, expect, rule):
    """The outcome of a case with these stops, whether it is met, strictly met, and what was allowed."""
    verdicts = [
        replace(first, status="pass" if statuses.count("pass") >= rule.needed(len(stops)) else "fail")
        for first, *others in zip(*(stop.criteria for stop in stops), strict=True)
        for statuses in [[first.status, *(each.status for each in others)]]
    ]
    outcome, reason = outcome_over_stops(stops, expect, rule, outcome_of(verdicts))
    repeats = Repeats(rule.name, tuple(stops), rule.share if rule.name == "at_least" else None)
    case = CaseResult("a", "a.yaml", {}, expect, outcome, reason, tuple(verdicts), repeats=repeats)
    return case.outcome, case.met, replace(case, strict=True).met, [each.id for each in case.allowed]


NAMED = expectation_of({"fail": ["a"]})
ALLOWED = NAMED.of_another_controller()


@pytest.mark.parametrize(
    ("missed", "expect", "rule", "found"),
    [
        # Every stop is held to the names: one at least is missed in each, and none beyond.
        (["a", "a", "a"], NAMED, ALL, ("fail", True, True, [])),
        (["a", "a", ""], NAMED, ALL, ("pass", False, False, [])),
        (["a", "a", "b"], NAMED, ALL, ("fail", False, False, [])),
        (["a", "a", "b"], NAMED, at_least(0.6), ("fail", True, True, [])),
        (["a", "b", "b"], NAMED, at_least(0.6), ("fail", False, False, [])),
        # What is allowed need not be missed; it is listed wherever it is what makes the case as expected.
        (["", "", ""], ALLOWED, ALL, ("pass", True, True, [])),
        (["a", "", ""], ALLOWED, ALL, ("fail", True, False, ["a"])),
        (["a", "b", ""], ALLOWED, ALL, ("fail", False, False, [])),
        (["a", "", ""], ALLOWED, at_least(0.6), ("pass", True, True, [])),
        (["a", "b", ""], ALLOWED, at_least(0.6), ("fail", True, False, ["a"])),
        (["a", "a", "b"], ALLOWED, at_least(0.6), ("fail", True, False, ["a"])),
        (["b", "b", ""], ALLOWED, at_least(0.6), ("fail", False, False, [])),
        # The verdicts at the median decide, those of the stops do not.
        (["a", "a", "a"], ALLOWED, MEDIAN, ("fail", True, False, ["a"])),
        (["ab", "ab", "ab"], ALLOWED, MEDIAN, ("fail", False, False, [])),
    ],
)
def test_every_repeat_is_held_to_the_names_and_a_share_of_them_must_be_as_expected(
    missed, expect, rule, found
):
    stops = [missing(seed, names) for seed, names in enumerate(missed)]
    assert came_out(stops, expect, rule) == found


def test_a_repeat_whose_rig_is_wrong_is_not_as_expected():
    grip = Verdict("grip", "rig", 2.0, "1", None, 1.0, -1.0, "fail", "slips")
    stop = missing(0, "a")
    wrong = replace(stop, outcome="invalid", criteria=(*stop.criteria, grip))
    for expect in (NAMED, ALLOWED, expectation_of("invalid")):
        assert outcome_over_stops([stop, wrong], expect, ALL, ("pass", ""))[0] != "pass"
        assert not wrong.as_expected(expect)


EVERY, MIDDLE = "all", "median"


def repeated(distances, rule=EVERY, expect="pass", **of_criterion):
    """Judge stops of these braking distances (m), None for one that ended in an error, by 440 .. 490 m."""
    tested = criterion(**{"lower": "440 m", "upper": "490 m", **of_criterion})
    resolved = scenario(profile(tested), expect=expect)
    resolved.outcome_of_repeats = rule
    together = case(resolved)

    def simulated(seed, distance):
        if distance is None:
            return SimulatedRepeat(seed, error_result(together, "made up"))
        records = stop(braking_distance=distance), wheelsets(0.1 * seed, 0.2, 0.3, 0.4)
        return SimulatedRepeat(seed, evaluate(together, *records, 1.5, detail="status"), *records)

    repeats = [simulated(seed, distance) for seed, distance in enumerate(distances, start=5)]
    return evaluate_repeats(together, repeats)


def test_a_verdict_that_turns_is_shown_as_such_and_under_the_median_as_well():
    result = repeated([450.0, 500.0, 470.0])
    assert (result.outcome, result.met) == ("invalid", False)
    (verdict,) = result.criteria
    assert (verdict.status, verdict.value, verdict.steady) == ("fail", 470.0, False)
    counts = verdict.over_stops
    assert (counts.passed, counts.failed, counts.lowest, counts.highest) == (2, 1, 450.0, 500.0)
    assert verdict.definition["bound"] == "440 .. 490 m"
    assert [stop.seed for stop in result.repeats.stops] == [5, 6, 7]
    assert [stop.outcome for stop in result.repeats.stops] == ["pass", "invalid", "pass"]
    result = repeated([450.0, 500.0, 470.0], MIDDLE)
    assert (result.outcome, result.reason) == ("pass", "")
    assert not result.criteria[0].steady
    # The figures of a stop whose rig is wrong are in every median.
    result = repeated([450.0, 500.0, 470.0], MIDDLE, layer="rig")
    assert (result.outcome, result.criteria[0].status) == ("invalid", "fail")
    assert "seed 6: " in result.criteria[0].reason


def test_measures_are_medians_over_the_stops_and_one_stop_is_judged_as_a_case_with_one():
    result = repeated([450.0, 480.0, 470.0, 460.0])
    assert result.measures["braking_distance_m"] == 465.0
    assert [wheelset["maximum_slide"] for wheelset in result.wheelsets] == pytest.approx(
        [0.65, 0.2, 0.3, 0.4]
    )
    assert result.duration == 6.0
    # The same value, margin, status and definitions; what is added are the counts.
    (verdict,) = repeated([450.0]).criteria
    assert (verdict.value, verdict.margin, verdict.status) == (450.0, 10.0, "pass")
    assert verdict.steady


def test_an_error_in_one_stop_makes_the_case_one_and_keeps_the_others():
    for rule in (EVERY, MIDDLE):
        result = repeated([450.0, None, 470.0], rule)
        assert result.outcome == "error"
        assert result.reason == "error in 1 of 3 stops (seed 6), with seed 6: made up"
        assert result.measures["braking_distance_m"] == 460.0
        assert result.criteria[0].over_stops.passed == 2
    nothing = repeated([None, None])
    assert (nothing.outcome, nothing.criteria, nothing.measures, nothing.wheelsets) == ("error", (), None, ())


def test_an_expected_invalid_needs_every_stop_and_a_share_is_stated_in_the_scenario():
    assert repeated([500.0, 510.0], expect="invalid").met
    assert repeated([500.0, 450.0], expect="invalid").outcome == "pass"
    assert not repeated([500.0, 450.0], expect="invalid").met
    rule = ShareOfStops.model_validate({"at_least": "60 %"})
    result = repeated([450.0, 500.0, 470.0], rule)
    assert (result.outcome, result.repeats.rule, result.repeats.required_share) == ("pass", "at_least", 0.6)
    assert repeated([450.0, 500.0, 510.0], rule).outcome == "invalid"


def test_definitions_run_through_their_range_in_all_stops_at_once():
    """One stop brakes hard for a second (its mean over T s is 0.08 g at T = 3), the other from the fourth
    second on (at T = 4.5): both keep 0.08 g from 3 to 4.5 s only.
    """
    phase = {"first_phase_duration": {"value": "4 s", "range": ["2 s", "5 s"]}}
    tested = criterion("initial_adhesion", upper="0.08 g", definition=phase)
    hard_first, hard_last = [0.12, *[0.06] * 9], [*[0.06] * 3, *[0.12] * 7]
    speeds = [33.0 - 9.80665 * np.cumsum([0.0, *each]) for each in (hard_first, hard_last)]
    slid = wheelsets(0.2, 0.2, 0.2, 0.2)
    stops = ((sliding_stop(speed_after_sliding=speed), slid) for speed in speeds)
    (verdict,) = evaluate_stops(scenario(profile(tested), condition="wet"), *stops).criteria
    assert verdict.status == "pass"
    assert verdict.value == pytest.approx((0.075 + 0.075) / 2)
    (sensitivity,) = verdict.sensitivity
    assert [(each.status, each.first, each.last) for each in sensitivity.intervals] == [
        ("fail", 2.0, pytest.approx(3.0, abs=1e-5)),
        ("pass", pytest.approx(3.0, abs=1e-5), pytest.approx(4.5, abs=1e-5)),
        ("fail", pytest.approx(4.5, abs=1e-5), 5.0),
    ]
