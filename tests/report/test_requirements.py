"""What a requirement comes to, from the verdicts of the cases and criteria that name it."""

import pytest

from uictest.report.requirements import requirements_of, verified_requirements

from .builders import make_result, make_verdict


def _only(*results):
    (requirement,) = verified_requirements(results)
    return requirement


@pytest.mark.parametrize(
    ("expect", "outcome", "word", "status"),
    [
        ("pass", "pass", "pass", "met"),
        ("pass", "fail", "fail", "not met"),
        ("pass", "invalid", "invalid", "not met"),
        ("pass", "inconclusive", "inconclusive", "not met"),
        ("pass", "error", "error", "not met"),
        ("pass", "skipped", "unexpected skip", "not tested"),
        ("skipped", "skipped", "skipped", "not tested"),
        ("fail", "fail", "expected fail", "met"),
        ("fail", "pass", "unexpected pass", "not met"),
    ],
)
def test_a_requirement_of_a_case_is_met_as_the_case_meets_its_expectation(expect, outcome, word, status):
    requirement = _only(make_result(expect=expect, outcome=outcome, requirements=("BR-1",)))
    assert ([each.word for each in requirement.evidence], requirement.status) == ([word], status)


OWN = {"id": "own", "layer": "requirement", "requirements": ("BR-1",)}


@pytest.mark.parametrize(
    ("own", "validity", "word"),
    [
        ("pass", "pass", "pass"),
        ("fail", "pass", "fail"),
        ("inconclusive", "pass", "inconclusive"),
        ("not_applicable", "pass", "not applicable"),
        ("not_applicable", "fail", "not applicable"),
        ("pass", "fail", "invalid"),
        ("fail", "fail", "fail"),
        ("pass", "inconclusive", "inconclusive"),
        ("fail", "inconclusive", "fail"),
        ("pass", "not_applicable", "pass"),
    ],
)
def test_a_requirement_of_a_criterion_is_met_only_by_a_stop_that_counts_as_a_test(own, validity, word):
    verdicts = (make_verdict(status=validity), make_verdict(**OWN, status=own))
    (evidence,) = _only(make_result(criteria=verdicts)).evidence
    assert (evidence.word, evidence.criteria) == (word, ("own",))


@pytest.mark.parametrize(
    ("validity", "word"),
    [("pass", "fail"), ("not_applicable", "fail"), ("fail", "invalid"), ("inconclusive", "inconclusive")],
)
def test_what_stands_in_a_valid_test_alone_is_missed_in_one_alone(validity, word):
    own = make_verdict(**OWN, status="fail", in_valid_test=True)
    (evidence,) = _only(make_result(criteria=(make_verdict(status=validity), own))).evidence
    assert evidence.word == word


@pytest.mark.parametrize("layer", ["rig", "record"])
@pytest.mark.parametrize("own", ["pass", "fail"])
def test_figures_that_are_not_those_of_the_test_say_nothing_of_a_requirement(layer, own):
    check = make_verdict(id="check", layer=layer, status="fail")
    (evidence,) = _only(make_result(criteria=(check, make_verdict(**OWN, status=own)))).evidence
    assert evidence.word == "invalid"


def test_a_case_that_names_the_requirement_of_its_criterion_counts_once_and_as_a_whole():
    result = make_result(outcome="fail", requirements=("BR-1",), criteria=(make_verdict(**OWN),))
    assert [(each.word, each.criteria) for each in _only(result).evidence] == [("fail", ())]


def test_two_criteria_of_a_requirement_must_both_pass_whatever_becomes_of_others():
    verdicts = (make_verdict(**OWN), make_verdict(**(OWN | {"id": "too"}), status="fail"))
    (evidence,) = _only(make_result(criteria=verdicts)).evidence
    assert (evidence.word, evidence.criteria) == ("fail", ("own", "too"))
    other = make_verdict(id="other", layer="requirement", status="fail")
    assert _only(make_result(outcome="fail", criteria=(make_verdict(**OWN), other))).status == "met"
    of_validity = make_verdict(status="fail", requirements=("BR-1",))
    assert _only(make_result(outcome="invalid", criteria=(of_validity,))).evidence[0].word == "fail"


@pytest.mark.parametrize("status", ["pass", "fail"])
def test_criteria_of_a_stop_that_must_not_pass_say_nothing_of_a_requirement(status):
    result = make_result(expect="fail", outcome="fail", criteria=(make_verdict(**OWN, status=status),))
    assert not verified_requirements([result])


def test_a_requirement_is_met_where_all_that_test_it_meet_it():
    passing = make_result(id="a", criteria=(make_verdict(**OWN),))
    skipped = make_result(id="b", criteria=(make_verdict(**OWN, status="not_applicable"),))
    failing = make_result(id="c", outcome="fail", requirements=("BR-1",))
    assert _only(passing, skipped).status == "met"
    requirement = _only(passing, skipped, failing)
    assert requirement.status == "not met"
    assert [each.id for each in requirement.tested] == ["a", "c"]
    assert [each.id for each in requirement.not_met] == ["c"]


def test_a_testcase_stands_for_its_own_requirements_and_those_of_criteria_that_apply():
    not_applicable = make_verdict(id="x", status="not_applicable", requirements=("BR-9",))
    verdicts = (make_verdict(requirements=("BR-2", "BR-1")), not_applicable)
    assert requirements_of(make_result(requirements=("BR-1",), criteria=verdicts)) == ("BR-1", "BR-2")
