"""The outcome of a case, and its narrowest margin on a scale that all criteria share."""

from dataclasses import replace
from itertools import product

import pytest

from uictest.judging.evaluation import (
    CaseResult,
    Sensitivity,
    Verdict,
    VerdictInterval,
    narrowest_margin,
    outcome_of,
    result_document,
    results_of,
)
from uictest.judging.evaluation.verdict import relative_margin
from uictest.plans.scenario import PASS

FLIPPING = Sensitivity(
    "cut-off", "km/h", 20.0, 40.0, (VerdictInterval(20, 30, "pass"), VerdictInterval(30, 40, "fail"))
)


def verdict(**changes):
    content = {
        "id": "distance",
        "layer": "requirement",
        "value": 450.0,
        "unit": "m",
        "lower": None,
        "upper": 500.0,
        "margin": 50.0,
        "status": "pass",
        "reason": "",
        "definition": {},
    }
    return Verdict(**(content | changes))


def result(*criteria):
    return CaseResult("stop", "stop.yaml", {}, PASS, "pass", criteria=criteria)


def test_a_margin_counts_over_its_bound_and_a_passed_one_that_hangs_on_a_definition_has_none():
    assert relative_margin(verdict()) == pytest.approx(0.1)
    assert relative_margin(verdict(margin=-25.0, status="fail")) == pytest.approx(-0.05)
    assert relative_margin(verdict(sensitivity=(FLIPPING,))) == 0.0
    missed = verdict(margin=-25.0, status="fail", sensitivity=(FLIPPING,))
    assert relative_margin(missed) == pytest.approx(-0.05)
    standstill = verdict(id="standstill", unit="1", value=1.0, lower=1.0, upper=None, margin=0.0)
    assert relative_margin(standstill) is None
    assert relative_margin(verdict(margin=None, status="not_applicable")) is None
    missed = verdict(id="standstill", unit="1", value=0.0, lower=1.0, upper=None, margin=-1.0, status="fail")
    assert relative_margin(missed) == -1.0


def test_the_narrowest_of_several_is_named():
    close = verdict(id="slide", unit="%", value=34.0, upper=35.0, margin=1.0)
    assert narrowest_margin(result(verdict(), close)) == (pytest.approx(1.0 / 35.0), "slide")
    assert narrowest_margin(result()) == (None, "")


OPEN, OPEN_TEST = "requirement-inconclusive: because", "validity-inconclusive: because"
FAILED = "requirement-fail: because"


def judged(layer, status):
    return Verdict(f"{layer}-{status}", layer, None, "m", None, 1.0, None, status, "because")


def _turning(first, last):
    intervals = VerdictInterval(10.0, 30.0, first), VerdictInterval(40.0, 60.0, last)
    return Sensitivity("low_speed_cutoff", "km/h", 10.0, 60.0, intervals)


@pytest.mark.parametrize(
    ("verdicts", "outcome", "reason"),
    [
        ([("validity", "pass"), ("requirement", "pass")], "pass", ""),
        ([("validity", "pass"), ("requirement", "not_applicable")], "pass", ""),
        ([("validity", "pass"), ("requirement", "fail")], "fail", FAILED),
        ([("requirement", "fail"), ("validity", "fail")], "fail", FAILED),
        ([("requirement", "pass"), ("validity", "fail")], "invalid", "validity-fail: because"),
        ([("validity", "not_applicable")], "skipped", "validity-not_applicable: because"),
        ([("validity", "not_applicable"), ("requirement", "fail")], "fail", FAILED),
        ([("validity", "pass"), ("requirement", "inconclusive")], "inconclusive", OPEN),
        ([("requirement", "fail"), ("requirement", "inconclusive")], "fail", FAILED),
        ([("validity", "inconclusive"), ("requirement", "fail")], "fail", FAILED),
        ([("validity", "inconclusive"), ("requirement", "pass")], "inconclusive", OPEN_TEST),
        ([("validity", "inconclusive"), ("validity", "fail")], "invalid", "validity-fail: because"),
        ([("validity", "not_applicable"), ("requirement", "inconclusive")], "inconclusive", OPEN),
        ([], "skipped", "no criterion"),
        # The figures of a rig that cannot be believed say nothing of the WSP.
        ([("rig", "fail"), ("requirement", "fail"), ("validity", "fail")], "invalid", "rig-fail: because"),
        ([("requirement", "fail"), ("record", "fail")], "invalid", "record-fail: because"),
        # What checks the rig is no judgement of the stop.
        ([("rig", "pass")], "skipped", "no criterion"),
        ([("rig", "pass"), ("validity", "not_applicable")], "skipped", "validity-not_applicable: because"),
        ([("rig", "inconclusive"), ("requirement", "pass")], "pass", ""),
    ],
)
def test_the_figures_come_before_requirements_and_these_before_validity(verdicts, outcome, reason):
    assert outcome_of(judged(*one) for one in verdicts) == (outcome, reason)


@pytest.mark.parametrize("layer", ["validity", "requirement"])
def test_nothing_passes_while_a_criterion_could_not_be_judged(layer):
    kinds = product(("validity", "requirement"), ("pass", "fail", "not_applicable", "inconclusive"))
    for others in product(list(kinds), repeat=2):
        verdicts = [judged(layer, "inconclusive"), *(judged(*each) for each in others)]
        assert outcome_of(verdicts)[0] in ("fail", "invalid", "inconclusive")


def test_the_order_of_the_criteria_does_not_matter():
    kinds = list(product(("validity", "requirement"), ("pass", "fail", "not_applicable", "inconclusive")))
    for one, other in product(kinds, kinds):
        assert outcome_of([judged(*one), judged(*other)])[0] == outcome_of([judged(*other), judged(*one)])[0]


@pytest.mark.parametrize(
    ("verdict", "settled"),
    [
        (judged("validity", "pass"), True),
        (judged("validity", "not_applicable"), True),
        (judged("requirement", "inconclusive"), False),
        (replace(judged("validity", "pass"), sensitivity=(_turning("pass", "fail"),)), False),
        (replace(judged("validity", "pass"), sensitivity=(_turning("pass", "pass"),)), True),
    ],
)
def test_a_strict_case_is_met_only_if_every_verdict_is_settled(verdict, settled):
    case = CaseResult("a", "a.yaml", {}, PASS, "pass", criteria=(verdict,))
    assert (case.met, case.unsettled) == (True, ())
    strict = replace(case, strict=True)
    assert (strict.met, strict.unsettled) == (settled, () if settled else (verdict,))
    (read,) = results_of(result_document([strict]))
    assert read.strict
