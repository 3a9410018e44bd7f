"""What a requirement comes to, from the verdicts of the cases, series and criteria that name it."""

from dataclasses import replace

import pytest

from uictest.report.requirements import (
    Evidence,
    evidence_table,
    requirements_of,
    requirements_table,
    verified_requirements,
)

from .builders import make_result, make_verdict
from .made_up_series import make_series


def only(*results, series=()):
    (requirement,) = verified_requirements(results, series)
    return requirement


@pytest.mark.parametrize("make", [make_result, make_series])
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
def test_a_requirement_is_met_as_what_names_it_meets_its_expectation(make, expect, outcome, word, status):
    result = make(expect=expect, outcome=outcome, requirements=("BR-1",))
    kind = {"series": [result]} if make is make_series else {}
    requirement = only(*([] if kind else [result]), **kind)
    assert requirement.evidence == (Evidence("series" if kind else "case", result.id, word),)
    assert requirement.status == status


OWN = {"id": "own", "layer": "requirement", "requirements": ("BR-1",)}


@pytest.mark.parametrize(
    ("own", "validity", "in_valid_test", "word"),
    [
        # A criterion is met only by a stop that counts as a test; what is missed is missed in any.
        ("pass", "pass", False, "pass"),
        ("fail", "pass", False, "fail"),
        ("inconclusive", "pass", False, "inconclusive"),
        ("not_applicable", "pass", False, "not applicable"),
        ("not_applicable", "fail", False, "not applicable"),
        ("pass", "fail", False, "invalid"),
        ("fail", "fail", False, "fail"),
        ("pass", "inconclusive", False, "inconclusive"),
        ("fail", "inconclusive", False, "fail"),
        ("pass", "not_applicable", False, "pass"),
        # What stands in a valid test alone is missed in one alone.
        ("fail", "pass", True, "fail"),
        ("fail", "not_applicable", True, "fail"),
        ("fail", "fail", True, "invalid"),
        ("fail", "inconclusive", True, "inconclusive"),
    ],
)
def test_a_requirement_of_a_criterion_follows_it_and_the_validity_of_the_stop(
    own, validity, in_valid_test, word
):
    verdict = make_verdict(**OWN, status=own, in_valid_test=in_valid_test)
    (evidence,) = only(make_result(criteria=(make_verdict(status=validity), verdict))).evidence
    assert (evidence.word, evidence.criteria) == (word, ("own",))


@pytest.mark.parametrize("layer", ["rig", "record"])
@pytest.mark.parametrize("own", ["pass", "fail"])
def test_figures_that_are_not_those_of_the_test_say_nothing_of_a_requirement(layer, own):
    check = make_verdict(id="check", layer=layer, status="fail")
    (evidence,) = only(make_result(criteria=(check, make_verdict(**OWN, status=own)))).evidence
    assert evidence.word == "invalid"


def naming(status="pass", **changes):
    """A series with a criterion of this status that names BR-1."""
    result = make_series(**changes)
    (judged,) = result.criteria
    verdict = replace(judged.verdict, status=status, requirements=("BR-1",))
    return replace(result, criteria=(replace(judged, verdict=verdict),))


@pytest.mark.parametrize(
    ("status", "outcome", "word"),
    [
        ("pass", "pass", "pass"),
        ("pass", "fail", "pass"),
        ("fail", "fail", "fail"),
        ("inconclusive", "inconclusive", "inconclusive"),
        ("not_applicable", "skipped", "not applicable"),
        # Criteria may have been judged although stops failed to run.
        ("pass", "error", "error"),
    ],
)
def test_a_requirement_of_a_criterion_of_a_series_follows_its_verdict(status, outcome, word):
    requirement = only(series=[naming(status, outcome=outcome)])
    assert requirement.evidence == (Evidence("series", "acceptance", word, ("k-wet",)),)


def test_two_criteria_of_a_requirement_must_both_pass_whatever_becomes_of_others():
    verdicts = (make_verdict(**OWN), make_verdict(**(OWN | {"id": "too"}), status="fail"))
    (evidence,) = only(make_result(criteria=verdicts)).evidence
    assert (evidence.word, evidence.criteria) == ("fail", ("own", "too"))
    other = make_verdict(id="other", layer="requirement", status="fail")
    assert only(make_result(outcome="fail", criteria=(make_verdict(**OWN), other))).status == "met"
    of_validity = make_verdict(status="fail", requirements=("BR-1",))
    assert only(make_result(outcome="invalid", criteria=(of_validity,))).evidence[0].word == "fail"
    # A case that names the requirement of its criterion counts once, and as a whole.
    result = make_result(outcome="fail", requirements=("BR-1",), criteria=(make_verdict(**OWN),))
    assert [(evidence.word, evidence.criteria) for evidence in only(result).evidence] == [("fail", ())]
    # A testcase stands for its own requirements, and those of criteria that apply.
    not_applicable = make_verdict(id="x", status="not_applicable", requirements=("BR-9",))
    verdicts = (make_verdict(requirements=("BR-2", "BR-1")), not_applicable)
    assert requirements_of(make_result(requirements=("BR-1",), criteria=verdicts)) == ("BR-1", "BR-2")


@pytest.mark.parametrize("status", ["pass", "fail"])
def test_criteria_of_what_must_not_pass_and_stops_of_a_series_are_no_evidence(status):
    result = make_result(expect="fail", outcome="fail", criteria=(make_verdict(**OWN, status=status),))
    assert not verified_requirements([result], [naming(status, expect="fail", outcome="fail")])
    series = make_series()
    cases = tuple(replace(each, case=replace(each.case, requirements=("BR-5",))) for each in series.cases)
    assert not verified_requirements([], [replace(series, cases=cases)])


def test_a_requirement_is_met_where_all_that_test_it_meet_it():
    passing = make_result(id="a", criteria=(make_verdict(**OWN),))
    skipped = make_result(id="b", criteria=(make_verdict(**OWN, status="not_applicable"),))
    failing = make_result(id="c", outcome="fail", requirements=("BR-1",))
    assert only(passing, skipped).status == "met"
    requirement = only(passing, skipped, failing)
    assert requirement.status == "not met"
    assert [evidence.id for evidence in requirement.tested] == ["a", "c"]
    assert [evidence.id for evidence in requirement.not_met] == ["c"]
    assert requirement.counts == (3, 0)


def test_tables_tell_a_case_and_a_series_of_the_same_id_apart_and_those_not_met_come_first():
    case = make_result(id="acceptance", requirements=("BR-10", "BR-9"), outcome="fail")
    verified = verified_requirements([case], [naming(requirements=("BR-9",))])
    assert [list(record.values()) for record in evidence_table(verified).records] == [
        ["BR-1", "met", "series", "acceptance", "pass", "k-wet"],
        ["BR-9", "not met", "case", "acceptance", "fail", ""],
        ["BR-9", "not met", "series", "acceptance", "pass", ""],
        ["BR-10", "not met", "case", "acceptance", "fail", ""],
    ]
    table = requirements_table(verified, most=5)
    assert [column.cell_text(row) for row in table.rows for column in table.columns] == [
        *("BR-9", "not met", "2", "acceptance (fail)"),
        *("BR-10", "not met", "1", "acceptance (fail)"),
        *("BR-1", "met", "1", ""),
    ]
    assert (table.more, table.columns[1].tone(table.rows[0])) == ("tables/requirements.csv", "bad")
