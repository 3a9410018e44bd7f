from itertools import product

import pytest

from uictest.evaluation import Verdict
from uictest.evaluation.outcome import outcome_of


def verdict(layer: str, judgement: str) -> Verdict:
    return Verdict(f"{layer}-{judgement}", layer, None, "m", None, 1.0, None, judgement, "because")


@pytest.mark.parametrize(
    ("verdicts", "outcome", "reason"),
    [
        ([("validity", "pass"), ("requirement", "pass")], "pass", ""),
        ([("validity", "pass"), ("requirement", "not_applicable")], "pass", ""),
        ([("validity", "pass"), ("requirement", "fail")], "fail", "requirement-fail: because"),
        ([("requirement", "fail"), ("validity", "fail")], "invalid", "validity-fail: because"),
        ([("validity", "not_applicable")], "skipped", "validity-not_applicable: because"),
        ([("validity", "not_applicable"), ("requirement", "fail")], "fail", "requirement-fail: because"),
        ([], "skipped", "no criterion"),
    ],
)
def test_validity_comes_before_requirements(verdicts, outcome: str, reason: str) -> None:
    assert outcome_of(verdict(*one) for one in verdicts) == (outcome, reason)


def test_the_order_of_the_criteria_does_not_matter() -> None:
    kinds = list(product(("validity", "requirement"), ("pass", "fail", "not_applicable")))
    for one, other in product(kinds, kinds):
        assert (
            outcome_of([verdict(*one), verdict(*other)])[0] == outcome_of([verdict(*other), verdict(*one)])[0]
        )
