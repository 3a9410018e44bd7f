from __future__ import annotations

from collections.abc import Callable

from uictest.evaluation import CaseResult, Sensitivity, Verdict, VerdictInterval
from uictest.report.page.page import worst_first

MakeResult = Callable[..., CaseResult]
MakeVerdict = Callable[..., Verdict]


def test_cases_not_met_come_first_then_narrow_margins_and_verdicts_that_flip(
    make_result: MakeResult, make_verdict: MakeVerdict
) -> None:
    flips = Sensitivity(
        "d", "s", 0.0, 1.0, (VerdictInterval(0.0, 0.5, "pass"), VerdictInterval(0.6, 1.0, "fail"))
    )
    results = [
        make_result(id="wide", criteria=(make_verdict(margin=200.0),)),
        make_result(id="narrow", criteria=(make_verdict(margin=2.0),)),
        make_result(id="flips", criteria=(make_verdict(margin=200.0, sensitivity=(flips,)),)),
        make_result(id="nothing", criteria=()),
        make_result(id="expected", outcome="fail", expect="fail"),
        make_result(id="missed", outcome="invalid"),
    ]
    assert [result.id for result in worst_first(results)] == [
        "missed",
        "expected",
        "flips",
        "narrow",
        "wide",
        "nothing",
    ]
