from typing import get_args

import pytest

from uictest.judging import evaluation
from uictest.judging.evaluation.result import Outcome
from uictest.report.case_words import CASE_WORDS, line_word, result_word, tone
from uictest.report.verdict_sentences import (
    counts_text,
    explanation,
    limits,
    number,
    quantity,
    tally,
    value_and_limits,
    verdict_sentence,
)

from .builders import make_result, make_verdict


@pytest.mark.parametrize(
    ("value", "shown"), [(465.2549, "465.25"), (1e-12, "1e-12"), (None, "-"), (float("nan"), "-"), (0.0, "0")]
)
def test_figures_have_five_digits_and_a_dash_where_there_is_none(value, shown):
    assert number(value) == quantity(value, "1") == shown
    assert quantity(465.0, "m") == "465 m"


@pytest.mark.parametrize(
    ("lower", "upper", "shown"),
    [
        (440.0, 490.0, "limits 440 .. 490 m"),
        (35.0, None, "lower limit 35 m"),
        (None, 0.08, "upper limit 0.08 m"),
        (None, None, "no limit"),
    ],
)
def test_limits(lower, upper, shown):
    assert limits(make_verdict(lower=lower, upper=upper)) == shown


def test_a_share_of_time_says_so_and_a_slide_does_not():
    share = {"value": 0.0, "unit": "%", "lower": 35.0, "upper": None}
    timed = make_verdict(measure="sliding_share", **share)
    assert value_and_limits(timed) == "0 % of the time, lower limit 35 %"
    assert value_and_limits(make_verdict(measure="maximum_slide_above_cutoff", **share)).startswith("0 %, ")


def test_a_skipped_case_tells_why_each_criterion_did_not_apply():
    absent = make_verdict(status="not_applicable", value=None, margin=None, reason="the rail is dry")
    assert explanation(make_result(outcome="skipped", criteria=(absent,))) == [
        "skipped. Expected: pass",
        "test validity: not judged; requirements: not judged",
        "braking-distance (validity) not applicable: the rail is dry",
    ]


def test_an_inconclusive_case_tells_what_could_not_be_judged():
    nothing = {"value": None, "margin": None}
    undecided = make_verdict(status="inconclusive", **nothing, reason="the record ends after 2 s")
    assert explanation(make_result(outcome="inconclusive", criteria=(make_verdict(), undecided))) == [
        "inconclusive: braking-distance. Expected: pass",
        "test validity: not judged; requirements: not judged",
        "braking-distance (validity) inconclusive: the record ends after 2 s",
    ]


@pytest.mark.parametrize(
    ("expect", "words"),
    [
        ("pass", ("pass", "fail", "invalid", "inconclusive", "error", "unexpected skip")),
        ("skipped", ("unexpected pass", "fail", "invalid", "inconclusive", "error", "skipped")),
        ("fail", ("unexpected pass", "expected fail", "invalid", "inconclusive", "error", "unexpected skip")),
        (
            "invalid",
            ("unexpected pass", "fail", "expected invalid", "inconclusive", "error", "unexpected skip"),
        ),
    ],
)
def test_the_word_of_a_case_says_outcome_and_expectation(expect, words):
    results = [make_result(outcome=outcome, expect=expect) for outcome in get_args(Outcome)]
    assert tuple(map(result_word, results)) == words
    # What is met looks good, and nothing else does.
    assert [tone(result_word(each)) == "good" for each in results] == [each.met for each in results]
    assert {word for word in words if tone(word) == "odd"} == {"error"}


def test_every_word_is_counted_and_is_one_field_of_a_line():
    counts = dict.fromkeys(CASE_WORDS, 1)
    assert len(counts_text(counts, 0).split(", ")) == len(CASE_WORDS)
    assert not any(" " in line_word(word) for word in CASE_WORDS)
    assert line_word("expected fail") == "expected-fail"


def test_the_margin_of_a_share_is_in_points_and_no_share_of_its_limit():
    share = make_verdict(value=100.0, unit="%", lower=90.0, upper=None, margin=10.0)
    assert verdict_sentence(share).endswith("100 %, lower limit 90 %, margin 10 points")
    assert verdict_sentence(make_verdict()).endswith("margin 24.75 m")


def test_the_tally_counts_only_what_there_is():
    passed, failed, error = make_result(), make_result(outcome="fail"), make_result(outcome="error")
    assert tally([passed]) == "1 case: 1 pass"
    assert tally([passed, failed, error, passed]) == "4 cases: 2 pass, 1 fail, 1 error; 2 not as expected"
    known, undecided = make_result(outcome="fail", expect="fail"), make_result(outcome="inconclusive")
    assert tally([known, undecided]) == "2 cases: 1 expected fail, 1 inconclusive; 1 not as expected"
    assert tally([passed, known], [known.id]) == "2 cases: 2 different from the baseline"
    assert tally([]) == "no case"


def test_a_strict_case_names_every_verdict_that_is_not_settled():
    intervals = (
        evaluation.VerdictInterval(10.0, 30.0, "pass"),
        evaluation.VerdictInterval(40.0, 60.0, "fail"),
    )
    turning = evaluation.Sensitivity("low_speed_cutoff", "km/h", 10.0, 60.0, intervals)
    verdict = make_verdict(id="minimum-slide", layer="validity", sensitivity=(turning,))
    strict = make_result(outcome="pass", strict=True, criteria=(verdict,))
    assert result_word(strict) == "unsettled"
    assert tone("unsettled") == "bad"
    assert explanation(strict) == [
        "pass, unsettled. Expected: pass",
        "test validity: valid; requirements: not judged",
        "minimum-slide (validity) turns: low_speed_cutoff 10 .. 60 km/h: pass 10 .. 30, fail 40 .. 60",
    ]
