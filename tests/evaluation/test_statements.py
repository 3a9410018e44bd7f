"""What verdicts come to, against the two tables of the interface, written down here once more by hand."""

from dataclasses import replace

import pytest
from hypothesis import example, given, strategies as st

from uictest.judging.evaluation import (
    CaseResult,
    Verdict,
    is_expected,
    missed_requirements,
    outcome_of,
    reasons_of,
    requirements_of,
    result_document,
    results_of,
    validity_of,
    why_no_test,
)
from uictest.plans.scenario import PASS, Expectation, expectation_of

LAYERS = ("rig", "record", "validity", "requirement")
STATUSES = ("pass", "fail", "inconclusive", "not_applicable")


def verdict(layer, status, name="", *, in_valid_test=False):
    return Verdict(
        name or f"{layer}-{status}",
        *(layer, 2.0, "s", None, 1.0, -1.0, status, "because"),
        in_valid_test=in_valid_test,
    )


NAMES = ("a", "b", "c")
"""Ids of requirements; those of validity are the same in capitals."""


@st.composite
def judged(draw, layers=LAYERS):
    """Verdicts on one stop: up to two checks, up to three criteria of validity and of requirement."""
    made = []
    for layer in layers:
        for name in draw(st.lists(st.sampled_from(NAMES), unique=True, max_size=3)):
            status = draw(st.sampled_from(STATUSES))
            own = (
                name if layer == "requirement" else name.upper() if layer == "validity" else f"{layer}-{name}"
            )
            stands = layer == "requirement" and draw(st.booleans())
            made.append(verdict(layer, status, own, in_valid_test=stands))
    return draw(st.permutations(made))


def table(verdicts):
    """The outcome by the table of the interface, row by row, of a stop that was run."""

    def has(layer, status):
        return any((each.layer, each.status) == (layer, status) for each in verdicts)

    if has("rig", "fail") or has("record", "fail"):
        return "invalid"
    if has("requirement", "fail"):
        # "In a valid test" includes tests whose validity no profile judges.
        valid = not has("validity", "fail") and not has("validity", "inconclusive")
        if valid or any(
            each.layer == "requirement" and each.status == "fail" and not each.in_valid_test
            for each in verdicts
        ):
            return "fail"
    if has("validity", "fail"):
        return "invalid"
    if has("validity", "inconclusive") or has("requirement", "inconclusive"):
        return "inconclusive"
    return "pass" if has("validity", "pass") or has("requirement", "pass") else "skipped"


@given(judged())
@example([verdict("validity", "inconclusive"), verdict("requirement", "fail", in_valid_test=True)])
@example([verdict("validity", "not_applicable"), verdict("requirement", "fail", in_valid_test=True)])
@example([verdict("validity", "fail"), verdict("requirement", "fail", in_valid_test=True)])
def test_the_outcome_is_the_first_row_of_the_table_that_holds(verdicts):
    assert outcome_of(verdicts)[0] == table(verdicts)


@given(judged())
def test_a_standing_requirement_that_is_missed_is_hidden_by_nothing_but_a_check(verdicts):
    stands = any(
        each.layer == "requirement" and each.status == "fail" and not each.in_valid_test for each in verdicts
    )
    checked = any(each.layer in ("rig", "record") and each.status == "fail" for each in verdicts)
    if stands:
        assert outcome_of(verdicts)[0] == ("invalid" if checked else "fail")
        assert requirements_of(verdicts) == "missed"
    if checked:
        assert validity_of(verdicts) == "not_valid"


@given(judged())
def test_both_statements_stand_whatever_the_other_says(verdicts):
    of_validity = [each for each in verdicts if each.layer != "requirement"]
    of_requirements = [each for each in verdicts if each.layer == "requirement"]
    assert validity_of(verdicts) == validity_of(of_validity)
    assert requirements_of(verdicts) == requirements_of(of_requirements)


@pytest.mark.parametrize(
    ("layer", "statuses", "validity", "requirements"),
    [
        ("validity", ["pass", "not_applicable"], "valid", "not_judged"),
        ("validity", ["pass", "inconclusive"], "not_judged", "not_judged"),
        ("validity", ["fail", "inconclusive"], "not_valid", "not_judged"),
        ("validity", ["not_applicable"], "not_judged", "not_judged"),
        ("rig", ["pass"], "not_judged", "not_judged"),
        ("rig", ["fail"], "not_valid", "not_judged"),
        ("record", ["fail"], "not_valid", "not_judged"),
        ("rig", ["inconclusive"], "not_judged", "not_judged"),
        ("requirement", ["pass", "not_applicable"], "not_judged", "met"),
        ("requirement", ["pass", "inconclusive"], "not_judged", "not_judged"),
        ("requirement", ["fail", "inconclusive"], "not_judged", "missed"),
        ("requirement", ["not_applicable"], "not_judged", "not_judged"),
    ],
)
def test_what_the_two_statements_are(layer, statuses, validity, requirements):
    verdicts = [verdict(layer, status) for status in statuses]
    assert (validity_of(verdicts), requirements_of(verdicts)) == (validity, requirements)


@pytest.mark.parametrize(
    ("validity", "stands"),
    [
        (["pass"], True),
        ([], True),
        (["not_applicable"], True),
        (["fail"], False),
        (["inconclusive"], False),
        (["pass", "inconclusive"], False),
        (["pass", "fail"], False),
    ],
)
def test_a_requirement_in_a_valid_test_stands_where_validity_holds_or_nothing_judges_it(validity, stands):
    of_validity = [verdict("validity", status) for status in validity]
    in_valid_test = verdict("requirement", "fail", "distance", in_valid_test=True)
    always = verdict("requirement", "fail", "locked-wheels")
    assert missed_requirements([*of_validity, in_valid_test]) == ([in_valid_test] if stands else [])
    assert missed_requirements([*of_validity, always]) == [always]
    assert requirements_of([*of_validity, in_valid_test]) == "missed"


def test_what_keeps_a_stop_from_counting_is_what_failed_else_what_could_not_be_judged():
    failed, undecided = verdict("validity", "fail"), verdict("validity", "inconclusive")
    of_rig, missed = verdict("rig", "fail"), verdict("requirement", "fail")
    assert why_no_test([undecided, failed, of_rig, missed]) == [failed, of_rig]
    assert why_no_test([undecided, verdict("rig", "inconclusive"), missed]) == [undecided]
    assert why_no_test([verdict("validity", "pass"), missed]) == []
    assert reasons_of([failed, of_rig]) == "validity-fail: because; rig-fail: because"


FAIL_A = {"fail": ["a"]}
FAIL_A_B = {"fail": ["a", "b"]}
INVALID_A = {"invalid": ["A"]}
BOTH = {"fail": ["a", "b"], "invalid": ["A"]}


@pytest.mark.parametrize(
    ("expect", "missed", "of_own", "of_another"),
    [
        # Only what is named may be missed, and of every kind that is named one at least must be.
        (FAIL_A, "a", True, True),
        (FAIL_A, "", False, True),
        (FAIL_A, "b", False, False),
        (FAIL_A, "a b", False, False),
        (FAIL_A, "A", False, False),
        (FAIL_A, "a A", False, False),
        (FAIL_A_B, "a", True, True),
        (FAIL_A_B, "b", True, True),
        (FAIL_A_B, "a b", True, True),
        (FAIL_A_B, "a b c", False, False),
        (INVALID_A, "A", True, True),
        (INVALID_A, "", False, True),
        (INVALID_A, "B", False, False),
        (INVALID_A, "A B", False, False),
        (INVALID_A, "a", False, False),
        (INVALID_A, "A a", False, False),
        (BOTH, "a A", True, True),
        (BOTH, "a b A", True, True),
        (BOTH, "a", False, True),
        (BOTH, "A", False, True),
        (BOTH, "", False, True),
        (BOTH, "a B", False, False),
        (BOTH, "a A B", False, False),
        (BOTH, "c A", False, False),
        # Without names: any, of the scenario's own controller alone.
        ("fail", "a", True, False),
        ("fail", "a b c", True, False),
        ("fail", "a A", True, False),
        ("fail", "A", False, False),
        ("fail", "", False, True),
        ("invalid", "A B", True, False),
        ("invalid", "a", False, False),
        ("invalid", "", False, True),
        ("pass", "", True, True),
        ("pass", "a", False, False),
        ("pass", "A", False, False),
    ],
)
def test_what_is_expected_of_the_own_controller_and_allowed_to_another(expect, missed, of_own, of_another):
    verdicts = [
        *(verdict("requirement", "fail" if name in missed.split() else "pass", name) for name in NAMES),
        *(verdict("validity", "fail" if name in missed.split() else "pass", name) for name in "ABC"),
    ]
    own = expectation_of(expect)
    assert _result(verdicts, own).as_expected is of_own
    assert _result(verdicts, own.of_another_controller()).as_expected is of_another
    # Nor is what criteria are named for where it is open whether the stop is a test.
    undecided = _result([*verdicts, verdict("validity", "inconclusive")], own)
    assert not (own.names_criteria and undecided.as_expected)
    # Nothing is expected of figures that are not those of the test.
    for layer in ("rig", "record"):
        spoiled = [*verdicts, verdict(layer, "fail")]
        assert not _result(spoiled, own).as_expected
        assert not _result(spoiled, own.of_another_controller()).as_expected


@pytest.mark.parametrize("expect", [PASS, Expectation("skipped")])
def test_pass_and_skipped_are_expected_of_every_controller(expect):
    assert expect.of_another_controller() == expect


@given(judged(), st.sampled_from(["inconclusive", "error"]))
def test_nothing_that_was_not_judged_is_expected(verdicts, outcome):
    for expect in ("pass", "fail", "invalid", "skipped", FAIL_A, BOTH):
        own = expectation_of(expect)
        assert not is_expected(outcome, verdicts, own)
        assert not is_expected(outcome, verdicts, own.of_another_controller())


def test_strict_asks_for_names_and_for_nothing_that_is_only_allowed():
    missed = [verdict("requirement", "fail", "a")]
    passed = [verdict("requirement", "pass", "a")]
    cases = {
        "unnamed": (_result(missed, Expectation("fail")), True, False),
        "named": (_result(missed, expectation_of(FAIL_A)), True, True),
        "allowed and used": (_result(missed, expectation_of(FAIL_A).of_another_controller()), True, False),
        "allowed, not used": (_result(passed, expectation_of(FAIL_A).of_another_controller()), True, True),
        "beyond": (_result(missed, expectation_of({"fail": ["b"]})), False, False),
    }
    found = {name: (each.met, replace(each, strict=True).met) for name, (each, *_) in cases.items()}
    assert found == {name: tuple(rest) for name, (_, *rest) in cases.items()}


def test_what_is_allowed_is_what_is_named_and_missed_and_only_where_it_is_all():
    both = [verdict("requirement", "fail", "a"), verdict("requirement", "pass", "b")]
    allowance = expectation_of(FAIL_A_B).of_another_controller()
    assert _result(both, allowance).allowed == (both[0],)
    assert _result(both, expectation_of(FAIL_A_B)).allowed == ()
    assert _result([*both, verdict("requirement", "fail", "c")], allowance).allowed == ()
    verdicts = [verdict("validity", "fail", "A"), verdict("requirement", "fail", "a", in_valid_test=True)]
    assert _result(verdicts, expectation_of(INVALID_A)).met
    assert not _result(verdicts, expectation_of(FAIL_A)).met


@given(judged(), st.sampled_from(["pass", "fail", "skipped", FAIL_A, BOTH]), st.booleans())
def test_the_document_has_both_statements_and_the_expectation_comes_back(verdicts, expect, another):
    own = expectation_of(expect)
    before = _result(verdicts, own.of_another_controller() if another else own)
    document = result_document([before])
    form = document["cases"][0]
    assert form["test_validity"] == validity_of(verdicts)
    assert form["requirement_status"] == requirements_of(verdicts)
    (read,) = results_of(document)
    assert read == before
    assert [each.in_valid_test for each in read.criteria] == [each.in_valid_test for each in verdicts]


def _result(verdicts, expect):
    outcome, reason = outcome_of(verdicts)
    return CaseResult("stop", "stop.yaml", {}, expect, outcome, reason, tuple(verdicts))
