from __future__ import annotations

from collections.abc import Callable

import pytest

from uictest.evaluation import CaseResult, Verdict
from uictest.report.wording import explanation, limits, number, quantity, tally

MakeResult = Callable[..., CaseResult]
MakeVerdict = Callable[..., Verdict]


@pytest.mark.parametrize(
    ("value", "shown"), [(465.2549, "465.25"), (1e-12, "1e-12"), (None, "-"), (float("nan"), "-"), (0.0, "0")]
)
def test_figures_have_five_digits_and_a_dash_where_there_is_none(value: float | None, shown: str) -> None:
    assert number(value) == shown


def test_a_pure_number_has_no_unit() -> None:
    assert (quantity(0.5, "1"), quantity(465.0, "m")) == ("0.5", "465 m")


@pytest.mark.parametrize(
    ("lower", "upper", "shown"),
    [
        (440.0, 490.0, "limits 440 .. 490 m"),
        (35.0, None, "lower limit 35 m"),
        (None, 0.08, "upper limit 0.08 m"),
        (None, None, "no limit"),
    ],
)
def test_limits(make_verdict: MakeVerdict, lower: float | None, upper: float | None, shown: str) -> None:
    assert limits(make_verdict(lower=lower, upper=upper)) == shown


def test_a_skipped_case_tells_why_each_criterion_did_not_apply(
    make_result: MakeResult, make_verdict: MakeVerdict
) -> None:
    absent = make_verdict(status="not_applicable", value=None, margin=None, reason="the rail is dry")
    assert explanation(make_result(outcome="skipped", criteria=(absent,))) == [
        "expected pass, came out skipped",
        "braking-distance (validity) not applicable: the rail is dry",
    ]


def test_an_inconclusive_case_tells_what_could_not_be_judged(
    make_result: MakeResult, make_verdict: MakeVerdict
) -> None:
    undecided = make_verdict(
        status="inconclusive", value=None, margin=None, reason="the record ends after 2 s"
    )
    assert explanation(make_result(outcome="inconclusive", criteria=(make_verdict(), undecided))) == [
        "expected pass, came out inconclusive",
        "braking-distance (validity) inconclusive: the record ends after 2 s",
    ]


def test_the_tally_counts_only_what_there_is(make_result: MakeResult) -> None:
    met, missed, error = make_result(), make_result(outcome="fail"), make_result(outcome="error")
    assert tally([met]) == "1 case: 1 met"
    assert tally([met, missed, error, met]) == "4 cases: 2 met, 1 missed, 1 in error"
    undecided = make_result(outcome="inconclusive")
    assert tally([met, missed, undecided]) == "3 cases: 1 met, 2 missed (1 inconclusive)"
