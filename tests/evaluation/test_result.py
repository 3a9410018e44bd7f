"""A result, its verdicts and its document."""

import math
from dataclasses import replace
from itertools import product

import pytest
from pydantic import ConfigDict, TypeAdapter

from uictest.judging.evaluation import (
    AppliedDefinition,
    CaseResult,
    Sensitivity,
    Verdict,
    VerdictInterval,
    WrittenVerdict,
    from_json_form,
    narrowest_margin,
    outcome_of,
    result_document,
    results_of,
    to_json_form,
)
from uictest.judging.evaluation.verdict import relative_margin
from uictest.plans.scenario import PASS

# The interface's names; `sensitivity` says what definitions do to it, the last two as data what was judged.
FIELDS = """
id layer value unit lower upper margin verdict reason definition sensitivity measure definitions
"""
VERDICTS = TypeAdapter(list[WrittenVerdict], config=ConfigDict(extra="forbid"))
SLIDE = Sensitivity(
    "low_speed_cutoff",
    "km/h",
    10.0,
    60.0,
    (VerdictInterval(10.0, 40.0, "pass"), VerdictInterval(50.0, 60.0, "fail")),
)
STEADY = Sensitivity("first_phase_duration", "s", 2.0, 5.0, (VerdictInterval(2.0, 5.0, "pass"),))


WHOLE = Verdict(
    *("minimum-slide", "validity", 80.0, "%", 35.0, None, 45.0, "pass", "2 of 4", {"clause": "Appendix B"}),
    sensitivity=(SLIDE, STEADY),
    measure="maximum_slide",
    definitions=(AppliedDefinition("low_speed_cutoff", 30 / 3.6, "m/s", "chosen", 10 / 3.6, 60 / 3.6),),
)


def verdict(**changes):
    return replace(WHOLE, **changes)


def form_of(verdict):
    return to_json_form(VERDICTS, [verdict])[0]


def read_back(form):
    return from_json_form(VERDICTS, [form])[0]


def test_the_json_form_has_the_fields_of_the_interface_and_comes_back_also_in_its_first_version():
    form = form_of(verdict())
    assert list(form) == [*FIELDS.split(), "requirements"]
    assert read_back(form) == verdict()
    del form["measure"], form["definitions"]
    assert read_back(form) == verdict(measure="", definitions=())
    form = form_of(verdict(value=math.inf, margin=math.nan))
    assert (form["value"], form["margin"]) == (None, None)


def test_a_verdict_knows_its_definitions_and_whether_it_flips_and_cannot_be_changed():
    assert verdict().defined("low_speed_cutoff") == 30 / 3.6
    assert verdict().defined("first_phase_duration") is None
    assert [entry["flips"] for entry in form_of(verdict())["sensitivity"]] == [True, False]
    assert not verdict().steady
    assert verdict(sensitivity=(STEADY,)).steady
    assert verdict(sensitivity=()).steady
    with pytest.raises(AttributeError):
        verdict().status = "fail"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"verdict": "maybe"}, "verdict: Input should be 'pass', 'fail'"),
        ({"value": "far"}, "value: Input should be a valid number"),
        ({"status": "pass"}, "status: Unexpected keyword argument"),
        ({"sensitivity": [{"definition": "low_speed_cutoff"}]}, "sensitivity.0.unit: Field required"),
    ],
)
def test_a_verdict_of_another_form_is_refused(changes, message):
    with pytest.raises(ValueError, match=message):
        read_back(form_of(verdict()) | changes)


FLIPPING = Sensitivity(
    "cut-off", "km/h", 20.0, 40.0, (VerdictInterval(20, 30, "pass"), VerdictInterval(30, 40, "fail"))
)


DISTANCE = Verdict("distance", "requirement", 450.0, "m", None, 500.0, 50.0, "pass", "")


def written_verdict(**changes):
    return replace(DISTANCE, **changes)


def result(*criteria):
    return CaseResult("stop", "stop.yaml", {}, PASS, "pass", criteria=criteria)


def test_a_margin_counts_over_its_bound_unless_it_hangs_on_a_definition_and_the_narrowest_is_named():
    assert relative_margin(written_verdict()) == pytest.approx(0.1)
    assert relative_margin(written_verdict(margin=-25.0, status="fail")) == pytest.approx(-0.05)
    assert relative_margin(written_verdict(sensitivity=(FLIPPING,))) == 0.0
    missed = written_verdict(margin=-25.0, status="fail", sensitivity=(FLIPPING,))
    assert relative_margin(missed) == pytest.approx(-0.05)
    standstill = written_verdict(id="standstill", unit="1", value=1.0, lower=1.0, upper=None, margin=0.0)
    assert relative_margin(standstill) is None
    assert relative_margin(written_verdict(margin=None, status="not_applicable")) is None
    missed = written_verdict(
        id="standstill", unit="1", value=0.0, lower=1.0, upper=None, margin=-1.0, status="fail"
    )
    assert relative_margin(missed) == -1.0
    close = written_verdict(id="slide", unit="%", value=34.0, upper=35.0, margin=1.0)
    assert narrowest_margin(result(written_verdict(), close)) == (pytest.approx(1.0 / 35.0), "slide")
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
