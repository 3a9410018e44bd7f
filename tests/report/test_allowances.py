"""What another controller than the scenario's own may miss by name, and what a run suggests to expect."""

from dataclasses import replace

import pytest
import yaml
from hypothesis import given, strategies as st

from uictest.judging.evaluation import RepeatedStop, Repeats, Verdict, outcome_of
from uictest.plans.scenario import expectation_of
from uictest.report.case_lines import expectation_lines
from uictest.report.ci_server import case_annotations, run_suites
from uictest.report.run_publication import cases_table
from uictest.report.verdict_sentences import explanation, tally
from uictest.report.words import result_word, tone

from .builders import HOSTILE, make_content, make_result, make_verdict

NAMED = {"fail": ["locked-wheels"]}
ALLOWANCE = expectation_of(NAMED).of_another_controller()
ALLOWED = "allowed: low-80: locked-wheels 62 s (limit 1 s)"


def locked(**changes):
    own = {"id": "locked-wheels", "layer": "requirement", "unit": "s", "lower": None, "upper": 1.0}
    return make_verdict(**{**own, "value": 62.0, "margin": -61.0, "status": "fail", **changes})


def allowing(*more, **changes):
    criteria = (make_verdict(), locked(), *more)
    outcome, reason = outcome_of(criteria)
    own = {"id": "low-80", "criteria": criteria, "outcome": outcome, "reason": reason, "expect": ALLOWANCE}
    return make_result(**{**own, **changes})


USED = allowing()
NOT_USED = make_result(id="low-80", expect=ALLOWANCE)
BEYOND = allowing(locked(id="total-locked-time", value=70.0))
GRIP = make_verdict(id="grip", value=0.09, unit="g", lower=None, upper=0.08, status="fail")
NO_GRIP = expectation_of({"invalid": ["grip"]}).of_another_controller()
INVALID = make_result(id="a", outcome="invalid", criteria=(GRIP,), expect=NO_GRIP)


def over_stops(result, *kinds, share=0.75):
    """The case with stops that judge the criteria of these cases."""
    stops = [RepeatedStop(seed, *outcome_of(kind.criteria), kind.criteria) for seed, kind in enumerate(kinds)]
    return replace(result, repeats=Repeats("all" if share is None else "at_least", tuple(stops), share))


@pytest.mark.parametrize(
    ("result", "word", "met", "counts", "outcome"),
    [
        (USED, "allowed fail", True, f"1 allowed fail; {ALLOWED}",
         "fail: locked-wheels 62 s (limit 1 s) (allowed)",),
        (NOT_USED, "pass", True, "1 pass", "pass (as expected)"),
        # Of the own controller the same is an unexpected pass.
        (make_result(expect=NAMED), "unexpected pass", False, "1 unexpected pass; 1 not as expected", None),
        (BEYOND, "fail", False, "1 fail; 1 not as expected",
         ("fail: locked-wheels 62 s (limit 1 s); total-locked-time 70 s (limit 1 s)."
         " Expected: pass or fail (locked-wheels)")),
        (replace(USED, strict=True), "fail", False, f"1 fail; 1 not as expected; {ALLOWED}",
         ("fail: locked-wheels 62 s (limit 1 s). Strict, and the expectation is an allowance:"
         " pass or fail (locked-wheels)")),
        (replace(USED, strict=True, expect=expectation_of("fail")), "fail", False,
         "1 fail; 1 not as expected",
         "fail: locked-wheels 62 s (limit 1 s). Strict, and the expectation names no criterion: fail",),
        (replace(NOT_USED, strict=True), "pass", True, "1 pass", "pass (as expected)"),
        (INVALID, "allowed invalid", True, "1 allowed invalid; allowed: a: grip 0.09 g (limit 0.08 g)",
         None,),
        (replace(INVALID, criteria=(replace(GRIP, layer="rig"),)), "invalid", False,
         "1 invalid; 1 not as expected", None,),
        # One that only some repeats use has the value of the first.
        (over_stops(replace(USED, criteria=NOT_USED.criteria), NOT_USED, USED, USED, NOT_USED),
         "allowed fail", True, f"1 allowed fail; {ALLOWED}", None,),
    ],
)  # fmt: skip
def test_an_allowance_that_is_used_is_never_green_and_what_is_missed_beyond_it_is_red(
    result, word, met, counts, outcome
):
    assert (result_word(result), result.met, tally([result])) == (word, met, f"1 case: {counts}")
    assert tone(word) == ("odd" if word.startswith("allowed") else "good" if met else "bad")
    assert outcome is None or explanation(result)[0] == outcome
    (suite,) = run_suites(make_content(result))
    assert suite.testcases[0].status == ("passed" if met else "failure")


def test_an_allowance_that_is_used_is_listed_in_every_report_and_three_in_the_headline():
    (suite,) = run_suites(make_content(USED))
    assert suite.testcases[0].lines[0] == ALLOWED
    (record,) = cases_table(make_content(USED)).records
    told = [record[key] for key in ("expect", "outcome", "test_validity", "requirement_status", "met")]
    assert told == ["pass or fail (locked-wheels)", "fail", "valid", "missed", True]
    (notice,) = case_annotations(make_content(USED), USED)
    assert notice.startswith(
        "::notice file=scenarios/dry/120.yaml,title=allowed fail low-80::fail: locked-wheels"
    )
    many = [replace(USED, id=f"low-{number}") for number in range(5)]
    assert tally(many).endswith("; allowed: low-2: locked-wheels 62 s (limit 1 s); 2 more allowed")
    assert tally(many).count("allowed: ") == 3
    assert "more allowed" not in tally(many[:3])
    assert tally([replace(USED, id=HOSTILE)]).isprintable()


NAMES = ("a", "b", "c")


@st.composite
def stop(draw):
    verdicts = []
    for layer in ("rig", "validity", "requirement"):
        for name in draw(st.lists(st.sampled_from(NAMES), unique=True, max_size=3)):
            status = draw(st.sampled_from(["pass", "pass", "fail", "not_applicable", "inconclusive"]))
            in_valid_test = layer == "requirement" and draw(st.booleans())
            numbers = (2.0, "s", None, 1.0, -1.0)
            verdicts.append(
                Verdict(f"{layer}-{name}", layer, *numbers, status, "2 s", in_valid_test=in_valid_test)
            )
    return tuple(verdicts)


@given(stop())
def test_what_is_suggested_is_met_when_it_is_pasted_and_strictly_so(verdicts):
    outcome, reason = outcome_of(verdicts)
    result = make_result(criteria=verdicts, outcome=outcome, reason=reason)
    place, line = expectation_lines([result])
    assert place == f"# {result.scenario}"
    checks = any(verdict.layer == "rig" and verdict.status == "fail" for verdict in verdicts)
    if line.startswith("#"):
        undecided = any(
            verdict.layer == "validity" and verdict.status == "inconclusive" for verdict in verdicts
        )
        assert checks or undecided or outcome == "inconclusive"
        return
    pasted = replace(result, expect=expectation_of(yaml.safe_load(line)["expect"]), strict=True)
    assert pasted.as_expected
    assert pasted.met or pasted.unsettled
    # It asks for no less than what came out: with everything held it is no longer met.
    held = tuple(replace(each, status="pass") if each.status == "fail" else each for each in verdicts)
    if any(verdict.status == "fail" for verdict in verdicts) and outcome in ("fail", "invalid"):
        assert not replace(pasted, criteria=held, outcome=outcome_of(held)[0], strict=False).met


DRY = "# scenarios/dry/120.yaml"
BOTH = "expect: {fail: [locked-wheels, total-locked-time]}"
LOCKED = "expect: {fail: [locked-wheels]}"


@pytest.mark.parametrize(
    ("results", "lines"),
    [
        ([USED, replace(USED, id="low-82"), make_result(scenario="b.yaml")], [DRY, LOCKED, "# b.yaml",
         "expect: pass"]),
        ([USED, replace(BEYOND, id="low-81")], [f"{DRY}: low-80", LOCKED, f"{DRY}: low-81", BOTH]),
        ([make_result(outcome="error", criteria=(), reason="no wheel load")], [DRY,
         "# nothing to expect: error: no wheel load"]),
        ([make_result(outcome="skipped", criteria=())], [DRY, "expect: skipped"]),
    ],
)  # fmt: skip
def test_suggestions_stand_once_for_cases_that_agree_and_by_case_where_they_do_not(results, lines):
    assert list(expectation_lines(results)) == lines


@pytest.mark.parametrize(
    ("stops", "share", "suggested"),
    [
        ((USED, BEYOND), None, BOTH),
        ((USED, BEYOND), 0.5, BOTH),
        ((USED, NOT_USED), 0.5, "expect: pass"),
        # Some stops pass, some do not: nothing holds of all of them.
        ((USED, NOT_USED), None, "# nothing to expect: fail: "),
    ],
)
def test_what_is_suggested_for_repeats_is_met(stops, share, suggested):
    outcome = "pass" if suggested == "expect: pass" else "fail"
    result = replace(stops[0], outcome=outcome, expect=expectation_of("pass"))
    result = over_stops(result, *stops, share=share)
    _, line = expectation_lines([result])
    assert line.startswith(suggested)
    if line.startswith("expect"):
        assert replace(result, expect=expectation_of(yaml.safe_load(line)["expect"])).met
