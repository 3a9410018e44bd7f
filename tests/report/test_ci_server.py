"""What a CI server is told: testcases of runs and series as suites, and annotations of GitHub."""

from dataclasses import replace

import pytest

from uictest.judging import series
from uictest.judging.evaluation import EffectivePart, Parameter
from uictest.plans.scenario import expectation_of
from uictest.report.ci_server import (
    annotation,
    missing_annotations,
    run_annotations,
    run_suites,
    series_annotations,
    series_suite,
)
from uictest.report.difference import BaselineComparison, Difference

from .builders import HOSTILE, make_content, make_result, make_verdict
from .made_up_series import MISSED, make_series


def suites(*results, named=False, **changes):
    return list(run_suites(make_content(*results, **changes), with_properties=named))


def annotations(*results, **changes):
    return list(run_annotations(make_content(*results, **changes)))


def told(*results, **changes):
    return [testcase for suite in suites(*results, **changes) for testcase in suite.testcases]


ID = "dry-120[command=90]"
AGAIN = f"run again: uictest run scenarios/dry/120.yaml -k '{ID}'"
BROKEN = make_verdict(status="fail", value=500.0, margin=-10.0, reason="500 m misses 440 .. 490 m")
ABSENT = make_verdict(status="not_applicable", value=None, margin=None, reason="the rail is dry")
DIFFERS = Difference("a", "braking_distance_m", 1.0, 2.0, False, "m", 1.0, 0.1)
BASELINE = BaselineComparison(
    "base", "00", differences={"a": [DIFFERS], "lost": [DIFFERS]}, missing={"lost": "b.yaml"}
)


def test_a_testcase_is_named_after_file_and_id_missed_ones_first_and_a_run_without_cases_has_an_empty_suite():
    (testcase,) = told(make_result())
    assert (testcase.class_name, testcase.name) == ("scenarios.dry.120", "dry-120[command=90]")
    assert (testcase.status, testcase.duration) == ("passed", 0.25)
    assert testcase.lines == ["test validity: valid; requirements: not judged"]
    good, bad = make_result(id="a"), make_result(id="b", outcome="fail")
    assert [testcase.name for testcase in told(good, bad)] == ["b", "a"]
    (suite,) = suites()
    assert (suite.name, suite.testcases, suite.duration) == ("uictest", [], 0)
    assert [suite.name for suite in suites(series=[make_series()])] == ["uictest series: acceptance"]


def test_a_missed_case_has_value_and_limit_in_its_message_and_everything_in_its_text():
    (testcase,) = told(make_result(outcome="invalid", criteria=(BROKEN,), reason="braking-distance: ..."))
    assert testcase.status == "failure"
    assert testcase.lines == [
        "invalid: braking-distance 500 m (440 to 490 m). Expected: pass",
        "test validity: not valid (braking-distance); requirements: not judged",
        "braking-distance (validity) fail: 500 m misses 440 .. 490 m",
        AGAIN,
    ]


@pytest.mark.parametrize(
    ("expect", "outcome", "status", "message"),
    [
        ("pass", "pass", "passed", ""),
        ("pass", "fail", "failure", "fail. Expected: pass"),
        ("pass", "invalid", "failure", "invalid. Expected: pass"),
        ("pass", "inconclusive", "failure", "inconclusive. Expected: pass"),
        ("pass", "error", "error", "error. Expected: pass"),
        ("pass", "skipped", "failure", "skipped. Expected: pass"),
        ("skipped", "skipped", "skipped", "skipped (as expected)"),
        ("fail", "fail", "passed", ""),
        ("fail", "pass", "failure", "pass. Expected: fail"),
    ],
)
def test_the_status_of_a_testcase_is_that_of_its_expectation(expect, outcome, status, message):
    (testcase,) = told(make_result(expect=expect, outcome=outcome, criteria=()))
    assert (testcase.status, [*testcase.lines, ""][0]) == (status, message)


def test_what_differs_from_the_baseline_fails_and_what_is_missing_has_a_testcase():
    differing, lost = told(make_result(id="a"), baseline=BASELINE)
    assert (differing.status, differing.kind) == ("failure", "baseline")
    assert differing.lines[0] == "pass (as expected). Differs from the baseline"
    deviation = "baseline: braking_distance_m was 1 m, is 2 m (+1; ±0.1 m allowed)"
    assert deviation in differing.lines
    assert (lost.class_name, lost.name, lost.status, lost.kind) == ("b", "lost", "failure", "baseline")
    assert list(lost.lines) == [deviation]
    # One that misses its expectation, too, is no failure of the baseline.
    assert told(make_result(id="a", outcome="fail"), baseline=BASELINE)[0].kind == ""
    assert list(missing_annotations(BASELINE)) == [f"::error file=b.yaml,title=differs lost::{deviation}"]


def test_polarion_and_xray_find_the_test_case_and_xray_the_requirements():
    """Names: Polarion's xUnit importer; Xray, "Import Execution Results", a comma list of requirements."""
    criteria = (make_verdict(requirements=("BR-2", "BR-1")), replace(ABSENT, id="x", requirements=("BR-3",)))
    results = [
        make_result(id="both", test_case="WSP-7", requirements=("BR-1",), criteria=criteria),
        make_result(id="requirements", requirements=("BR-10", "BR-9")),
        make_result(id="test-case", test_case="WSP-8"),
        make_result(id="neither"),
    ]
    (suite,) = suites(*results, named=True)
    assert {testcase.name: dict(testcase.properties) for testcase in suite.testcases} == {
        "both": {"polarion-testcase-id": "WSP-7", "test_key": "WSP-7", "requirements": "BR-1,BR-2"},
        "requirements": {"polarion-testcase-id": "", "test_key": "", "requirements": "BR-10,BR-9"},
        "test-case": {"polarion-testcase-id": "WSP-8", "test_key": "WSP-8", "requirements": ""},
        "neither": {"polarion-testcase-id": "", "test_key": "", "requirements": ""},
    }
    (plain,) = suites(*results)
    assert not any(testcase.properties for testcase in plain.testcases)
    assert plain.properties["requirements"] == suite.properties["requirements"] == "BR-1,BR-2,BR-9,BR-10"


def controller(name, **facts):
    parameters = (Parameter(f"controller.{key}", text, "", text, "user") for key, text in facts.items())
    return EffectivePart("controller", "controller", name, None, tuple(parameters))


def test_cases_of_each_controller_from_outside_have_a_suite_that_says_which_it_is():
    python = {"python": "wsp.py", "sha256": "1" * 64, "version": "2.1"}
    own = [make_result(id=name, parts={"controller": controller("Wsp", **python)}) for name in ("a", "d")]
    built_in = make_result(id="b", parts={"controller": controller("threshold", algorithm="threshold")})
    at = "tcp://rig:5025"
    remote = make_result(id="c", parts={"controller": controller(at, connect=at)})
    of_own, of_built_in, of_remote = suites(own[0], built_in, remote, own[1])
    facts = {"kind": "python", "source": "wsp.py", "version": "2.1", "sha256": "1" * 64}
    stated = {"controller": "Wsp"} | {f"controller.{key}": text for key, text in facts.items()}
    of_socket = {"controller": at, "controller.kind": "connect", "controller.source": at}
    for suite, name, cases, properties in (
        (of_own, "uictest: Wsp", ["a", "d"], stated),
        (of_built_in, "uictest", ["b"], {"controller": "threshold", "controller.version": "uictest 0.1.0"}),
        (of_remote, f"uictest: {at}", ["c"], of_socket),
    ):
        assert (suite.name, [testcase.name for testcase in suite.testcases]) == (name, cases)
        assert {key: text for key, text in suite.properties.items() if text} == properties
    part = {"controller": controller("wsp", library="wsp.so")}
    versions = ("1.2", "1.3", "")
    (suite,) = suites(*(make_result(id=f"x{own}", parts=part, controller_version=own) for own in versions))
    assert suite.properties["controller.version"] == "1.2, 1.3"
    (failed,) = told(make_result(outcome="fail", parts=part, controller_version="1.2"))
    assert "controller: wsp (version 1.2)" in failed.lines


@pytest.mark.parametrize(
    ("result", "statuses", "said"),
    [
        (make_series(), {"k-wet": "passed"}, "dry 2 of 2, wet 5 of 6"),
        (MISSED, {"k-wet": "failure"},
         "k-wet fail: 0.8696 (0.9 needed) from 120 km/h",),
        (replace(MISSED, expect=expectation_of("fail")), {"k-wet": "passed"}, "1 stop invalid, not counted"),
        (make_series(expect="fail"), {"k-wet": "passed", "outcome": "failure"}, "pass. Expected: fail"),
        (make_series(outcome="error", reason="1 of 7 stops failed to run; it broke"), {"k-wet": "passed",
         "outcome": "error"}, "it broke",),
        (make_series(criteria=(series.SeriesVerdict(ABSENT),), outcome="skipped", expect="skipped"),
         {"braking-distance": "skipped"}, "the rail is dry",),
        (make_series(criteria=(series.SeriesVerdict(replace(ABSENT, status="inconclusive",
         reason="too few stops")),), outcome="inconclusive",), {"braking-distance": "failure"},
         "too few stops",),
    ],
)  # fmt: skip
def test_every_criterion_of_a_series_is_a_testcase_and_what_none_says_has_one_of_its_own(
    result, statuses, said
):
    suite = series_suite(result)
    assert {each.name.removeprefix("acceptance: "): each.status for each in suite.testcases} == statuses
    assert {each.class_name for each in suite.testcases} == {"tests.acceptance.series"}
    assert said in "\n".join(line for each in suite.testcases for line in each.lines)


def test_testcases_of_a_series_name_its_requirements_and_those_of_their_criterion():
    (judged,) = make_series().criteria
    verdict = replace(judged.verdict, requirements=("BR-1",))
    named = {
        "criteria": (replace(judged, verdict=verdict),),
        "requirements": ("BR-9",),
        "test_case": "WSP-TC-7",
    }
    result = make_series(expect="fail", **named)
    of_criterion, outcome = series_suite(result, with_properties=True).testcases
    ids = {"polarion-testcase-id": "WSP-TC-7", "test_key": "WSP-TC-7"}
    assert of_criterion.properties == {**ids, "requirements": "BR-9,BR-1"}
    assert outcome.properties == {**ids, "requirements": "BR-9"}
    plain = series_suite(result)
    assert plain.properties["requirements"] == "BR-1,BR-9"
    assert not any(testcase.properties for testcase in plain.testcases)


@pytest.mark.parametrize(
    ("told", "command"),
    [
        (("a.yaml", "key", "100 %", 3, 7), "::error file=a.yaml,line=3,col=7,title=key::100 %25"),
        (("a.yaml", "a:b,c", "x\ny", None, None, "notice"), "::notice file=a.yaml,title=a%3Ab%2Cc::x%0Ay"),
    ],
)
def test_an_annotation_carries_its_level_and_the_place_in_the_file(told, command):
    assert annotation(*told) == command


def test_only_what_is_not_met_is_annotated_and_a_hostile_name_cannot_start_a_command_of_its_own():
    assert annotations(make_result()) == list(series_annotations(make_series())) == []
    assert annotations(make_result(outcome="fail", criteria=(), reason="locked")) == [
        f"::error file=scenarios/dry/120.yaml,title=fail {ID}::fail. Expected: pass%0Alocked%0A{AGAIN}"
    ]
    (line,) = series_annotations(MISSED)
    assert line.startswith("::error file=tests/acceptance.series.yaml,title=fail acceptance::fail: k-wet")
    differs, _ = annotations(make_result(id="a"), baseline=BASELINE)
    assert differs.startswith("::error file=scenarios/dry/120.yaml,title=differs a::pass (as expected)")
    (line,) = annotations(make_result(id=HOSTILE, scenario=HOSTILE, outcome="error", reason=HOSTILE))
    assert line.startswith("::error file=")
    assert not set("\n\r\x00\x1b\u202e") & set(line)
    assert line.split("::")[1].count(",") == 1
