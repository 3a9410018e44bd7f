"""What another controller than the scenario's own may miss by name: never green, never folded away."""

import csv
import io
from dataclasses import replace
from xml.etree import ElementTree

import pytest
import yaml
from hypothesis import given, strategies as st

from uictest.judging.evaluation import RepeatedStop, Repeats, Verdict, outcome_of
from uictest.plans.scenario import expectation_of
from uictest.report import (
    case_line,
    csv_text,
    expectation_lines,
    junit_text,
    line_word,
    result_word,
    run_suites,
    tally,
    tone,
)
from uictest.report.formats import csv as tables
from uictest.report.formats.md import markdown_summary
from uictest.report.page import page_html
from uictest.report.verdict_sentences import explanation

from .builders import HOSTILE, make_content, make_result, make_verdict

NAMED = {"fail": ["locked-wheels"]}
ALLOWANCE = expectation_of(NAMED).of_another_controller()
ALLOWED = "allowed: low-80: locked-wheels 62 s, upper limit 1 s"


def _locked(**changes):
    own = {"id": "locked-wheels", "layer": "requirement", "unit": "s", "lower": None, "upper": 1.0}
    return make_verdict(**{**own, "value": 62.0, "margin": -61.0, "status": "fail", **changes})


def _result(*more, **changes):
    criteria = (make_verdict(), _locked(), *more)
    outcome, reason = outcome_of(criteria)
    own = {"id": "low-80", "criteria": criteria, "outcome": outcome, "reason": reason, "expect": ALLOWANCE}
    return make_result(**{**own, **changes})


USED = _result()
NOT_USED = make_result(id="low-80", expect=ALLOWANCE)
BEYOND = _result(_locked(id="total-locked-time", value=70.0))


def _failures(result):
    (testcase,) = ElementTree.fromstring(junit_text(run_suites([result]))).iter("testcase")
    return testcase.find("failure"), testcase.findtext("system-out") or ""


def test_an_allowance_that_is_used_is_listed_with_its_value_in_every_report():
    assert (result_word(USED), line_word(result_word(USED))) == ("allowed fail", "allowed-fail")
    assert (USED.met, tone("allowed fail"), tone("allowed invalid")) == (True, "odd", "odd")
    assert tally([make_result(), USED]) == f"2 cases: 1 pass, 1 allowed fail; {ALLOWED}"
    assert explanation(USED)[:2] == [
        "fail: locked-wheels 62 s, upper limit 1 s (allowed)",
        "test validity: valid; requirements: missed (locked-wheels)",
    ]
    assert case_line(USED).startswith(
        "allowed-fail low-80 outcome=fail expect=passorfail(locked-wheels) test_validity=valid requirements="
    )
    failure, told = _failures(USED)
    assert failure is None
    assert told.splitlines()[0] == ALLOWED
    page = page_html(make_content(make_result(), USED))
    assert f'<h1 class="tally-odd">2 cases: 1 pass, 1 allowed fail; {ALLOWED}</h1>' in page
    summary = markdown_summary(make_content(USED))
    assert f"## uictest: 1 case: 1 allowed fail; {ALLOWED}" in summary.replace("&#58;", ":")
    (row,) = csv.DictReader(io.StringIO(csv_text(*tables.summary_table([USED]))))
    own = [row[name] for name in ("expect", "outcome", "test_validity", "requirement_status", "met")]
    assert own == ["pass or fail (locked-wheels)", "fail", "valid", "missed", "true"]


def test_a_controller_that_does_not_need_its_allowance_passes():
    assert (result_word(NOT_USED), NOT_USED.met, NOT_USED.allowed) == ("pass", True, ())
    assert tally([NOT_USED]) == "1 case: 1 pass"
    assert '<h1 class="tally-good">' in page_html(make_content(NOT_USED))
    assert _failures(NOT_USED) == (None, "test validity: valid; requirements: not judged")
    # Of the own controller the same is an unexpected pass.
    assert result_word(make_result(expect=NAMED)) == "unexpected pass"


def test_what_is_missed_beyond_the_names_is_red_and_allows_nothing():
    assert (result_word(BEYOND), BEYOND.met, BEYOND.allowed) == ("fail", False, ())
    assert tally([BEYOND]) == "1 case: 1 fail; 1 not as expected"
    failure, _ = _failures(BEYOND)
    assert failure.get("message") == (
        "fail: locked-wheels 62 s, upper limit 1 s; total-locked-time 70 s, upper limit 1 s."
        " Expected: pass or fail (locked-wheels)"
    )
    assert '<h1 class="tally-bad">' in page_html(make_content(BEYOND, NOT_USED))
    # Red outweighs what is allowed beside it.
    assert '<h1 class="tally-bad">' in page_html(make_content(BEYOND, USED))


def test_strict_makes_an_allowance_red_and_says_so():
    strict = replace(USED, strict=True)
    assert (result_word(strict), strict.met) == ("fail", False)
    failure, _ = _failures(strict)
    assert failure.get("message") == (
        "fail: locked-wheels 62 s, upper limit 1 s. Strict, and the expectation is an allowance:"
        " pass or fail (locked-wheels)"
    )
    unnamed = replace(USED, strict=True, expect=expectation_of("fail"))
    assert explanation(unnamed)[0].endswith("Strict, and the expectation names no criterion: fail")
    assert replace(NOT_USED, strict=True).met


def test_the_headline_names_three_allowances_and_counts_the_others():
    many = [replace(USED, id=f"low-{number}") for number in range(5)]
    assert tally(many).endswith("; allowed: low-2: locked-wheels 62 s, upper limit 1 s; 2 more allowed")
    assert tally(many).count("allowed: ") == 3
    assert tally(many[:3]).count("more allowed") == 0


def test_an_invalid_that_is_allowed_is_listed_alike():
    expect = expectation_of({"invalid": ["grip"]}).of_another_controller()
    grip = make_verdict(id="grip", value=0.09, unit="g", lower=None, upper=0.08, status="fail")
    result = make_result(id="a", outcome="invalid", criteria=(grip,), expect=expect)
    assert tally([result]) == "1 case: 1 allowed invalid; allowed: a: grip 0.09 g, upper limit 0.08 g"
    assert not replace(result, criteria=(replace(grip, layer="rig"),)).met


def test_an_allowance_only_some_repeats_use_has_the_value_of_the_first():
    missed, kept = USED.criteria, NOT_USED.criteria
    stops = [
        RepeatedStop(seed, *outcome_of(own), own) for seed, own in enumerate((kept, missed, missed, kept))
    ]
    repeats = Repeats("at_least", tuple(stops), 0.75)
    result = replace(USED, criteria=kept, repeats=repeats)
    assert (result.met, result_word(result)) == (True, "allowed fail")
    assert tally([result]).endswith(ALLOWED)


def test_hostile_ids_in_an_allowance_stay_text():
    result = replace(USED, id=HOSTILE)
    assert "\x1b" not in tally([result]) + case_line(result)
    assert "<b>&" not in page_html(make_content(result))


NAMES = ("a", "b", "c")


@st.composite
def _stop(draw):
    verdicts = []
    for layer in ("rig", "validity", "requirement"):
        for name in draw(st.lists(st.sampled_from(NAMES), unique=True, max_size=3)):
            status = draw(st.sampled_from(["pass", "pass", "fail", "not_applicable", "inconclusive"]))
            in_valid_test = layer == "requirement" and draw(st.booleans())
            verdicts.append(
                Verdict(
                    *(f"{layer}-{name}", layer, 2.0, "s", None, 1.0, -1.0, status, "2 s"),
                    in_valid_test=in_valid_test,
                )
            )
    return tuple(verdicts)


@given(_stop())
def test_what_is_suggested_is_met_when_it_is_pasted_and_strictly_so(verdicts):
    outcome, reason = outcome_of(verdicts)
    result = make_result(criteria=verdicts, outcome=outcome, reason=reason)
    place, line = expectation_lines([result])
    assert place == f"# {result.scenario}"
    checks = any(each.layer == "rig" and each.status == "fail" for each in verdicts)
    if line.startswith("#"):
        open_ = any(each.layer == "validity" and each.status == "inconclusive" for each in verdicts)
        assert checks or open_ or outcome == "inconclusive"
        return
    pasted = replace(result, expect=expectation_of(yaml.safe_load(line)["expect"]), strict=True)
    assert pasted.as_expected
    assert pasted.met or pasted.unsettled
    # It asks for no less than what came out: with everything held it is no longer met.
    held = tuple(replace(each, status="pass") if each.status == "fail" else each for each in verdicts)
    if any(each.status == "fail" for each in verdicts) and outcome in ("fail", "invalid"):
        own_outcome, _ = outcome_of(held)
        assert not replace(pasted, criteria=held, outcome=own_outcome, strict=False).met


def test_suggestions_stand_once_for_cases_that_agree_and_by_case_where_they_do_not():
    other = replace(BEYOND, id="low-81")
    assert list(expectation_lines([USED, replace(USED, id="low-82"), make_result(scenario="b.yaml")])) == [
        "# scenarios/dry/120.yaml",
        "expect: {fail: [locked-wheels]}",
        "# b.yaml",
        "expect: pass",
    ]
    assert list(expectation_lines([USED, other])) == [
        "# scenarios/dry/120.yaml: low-80",
        "expect: {fail: [locked-wheels]}",
        "# scenarios/dry/120.yaml: low-81",
        "expect: {fail: [locked-wheels, total-locked-time]}",
    ]
    crashed = make_result(outcome="error", criteria=(), reason="no wheel load")
    assert list(expectation_lines([crashed]))[1] == "# nothing to expect: error: no wheel load"


@pytest.mark.parametrize(
    ("stops", "share", "suggested"),
    [
        ((USED, BEYOND), None, "expect: {fail: [locked-wheels, total-locked-time]}"),
        ((USED, BEYOND), 0.5, "expect: {fail: [locked-wheels, total-locked-time]}"),
        ((USED, NOT_USED), 0.5, "expect: pass"),
        # Some stops pass, some do not: nothing holds of all of them.
        ((USED, NOT_USED), None, "# nothing to expect: fail: "),
    ],
)
def test_what_is_suggested_for_repeats_is_met(stops, share, suggested):
    each = [RepeatedStop(seed, *outcome_of(own.criteria), own.criteria) for seed, own in enumerate(stops)]
    repeats = Repeats("all" if share is None else "at_least", tuple(each), share)
    outcome = "pass" if suggested == "expect: pass" else "fail"
    result = replace(stops[0], outcome=outcome, expect=expectation_of("pass"), repeats=repeats)
    _, line = expectation_lines([result])
    assert line.startswith(suggested)
    if line.startswith("expect"):
        assert replace(result, expect=expectation_of(yaml.safe_load(line)["expect"])).met
