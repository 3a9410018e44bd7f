from itertools import product

import pytest

from uictest.evaluation import Verdict
from uictest.evaluation.outcome import outcome_of

OPEN, OPEN_TEST = "requirement-inconclusive: because", "validity-inconclusive: because"
FAILED = "requirement-fail: because"


def verdict(layer: str, judgement: str) -> Verdict:
    return Verdict(f"{layer}-{judgement}", layer, None, "m", None, 1.0, None, judgement, "because")


@pytest.mark.parametrize(
    ("verdicts", "outcome", "reason"),
    [
        ([("validity", "pass"), ("requirement", "pass")], "pass", ""),
        ([("validity", "pass"), ("requirement", "not_applicable")], "pass", ""),
        ([("validity", "pass"), ("requirement", "fail")], "fail", FAILED),
        ([("requirement", "fail"), ("validity", "fail")], "invalid", "validity-fail: because"),
        ([("validity", "not_applicable")], "skipped", "validity-not_applicable: because"),
        ([("validity", "not_applicable"), ("requirement", "fail")], "fail", FAILED),
        ([("validity", "pass"), ("requirement", "inconclusive")], "inconclusive", OPEN),
        ([("requirement", "fail"), ("requirement", "inconclusive")], "fail", FAILED),
        ([("validity", "inconclusive"), ("requirement", "fail")], "inconclusive", f"{OPEN_TEST}; {FAILED}"),
        ([("validity", "inconclusive"), ("validity", "fail")], "invalid", "validity-fail: because"),
        ([("validity", "not_applicable"), ("requirement", "inconclusive")], "inconclusive", OPEN),
        ([], "skipped", "no criterion"),
    ],
)
def test_validity_comes_before_requirements(verdicts, outcome: str, reason: str) -> None:
    assert outcome_of(verdict(*one) for one in verdicts) == (outcome, reason)


@pytest.mark.parametrize("layer", ["validity", "requirement"])
def test_nothing_passes_while_a_criterion_could_not_be_judged(layer: str) -> None:
    kinds = product(("validity", "requirement"), ("pass", "fail", "not_applicable", "inconclusive"))
    for others in product(list(kinds), repeat=2):
        verdicts = [verdict(layer, "inconclusive"), *(verdict(*each) for each in others)]
        assert outcome_of(verdicts)[0] in ("fail", "invalid", "inconclusive")


def test_the_order_of_the_criteria_does_not_matter() -> None:
    kinds = list(product(("validity", "requirement"), ("pass", "fail", "not_applicable", "inconclusive")))
    for one, other in product(kinds, kinds):
        assert (
            outcome_of([verdict(*one), verdict(*other)])[0] == outcome_of([verdict(*other), verdict(*one)])[0]
        )
