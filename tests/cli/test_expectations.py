"""Scenarios under other controllers and on a wrong rig: what is green, what is listed, what is red."""

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml

from uictest.plans import scenario as scenarios

from .conftest import results_of, verdicts_in

LOCKED = "locked-wheels"
NAMED = f"{{fail: [{LOCKED}, total-locked-time, distance-over-reference]}}"
ANOTHER = ("--set", "controller.cycle_time=20 ms")
"""Another controller than slip-band as it ships; under it wheels lock as well."""


def _case():
    (case,) = results_of()["cases"]
    return case


@pytest.fixture
def slipping(workplace):
    """Write a short stop on a wet rail, in which wheels lock under slip-band; return its path."""

    def write(expect, controller="slip-band"):
        path = workplace / "slipping.yaml"
        path.write_text(
            "schema: uictest/scenario/1\nname: slipping\ninitial_speed: 40 km/h\ncriteria: [uictest-stop]\n"
            f"rail: {{condition: wet, friction: 0.05}}\ncontroller: {controller}\nexpect: {expect}\n",
            "utf-8",
        )
        return path

    return write


def test_neither_a_failed_requirement_nor_a_wrong_rig_is_hidden_by_what_is_expected(call, workplace):
    # The rail recovers, so that the stop is no slip test; a wheelset takes 2.3 MJ where 1.5 are allowed.
    answer = call("run", "cleaned-rail-120", "--set", "controller=slip-band", code=1)
    case = _case()
    assert (case["outcome"], case["test_validity"], case["requirement_status"]) == (
        *("fail", "not_valid", "missed"),
    )
    assert verdicts_in(answer.out) == {"cleaned-rail-120": "fail"}
    assert "\n  wheelset-contact-energy: " in answer.out
    call("run", "wsp-bypassed-80", code=0)
    answer = call("run", "wsp-bypassed-80", "--set", "rig.caliper.lever_ratio=3", code=1)
    assert verdicts_in(answer.out) == {"wsp-bypassed-80": "invalid"}
    case = _case()
    assert (case["test_validity"], case["requirement_status"]) == ("not_valid", "missed")
    # Nor by an invalid test that is expected, whatever its reason is.
    options = ("--set", "rig.caliper.lever_ratio=3", "--set", "expect=invalid")
    call("run", "wsp-bypassed-80", *options, code=1)


def test_an_allowance_is_named_in_the_tally_and_red_when_strict(call, slipping):
    path = slipping(NAMED)
    call("run", path, "--strict", code=0)
    assert "PASSED: 1 case: 1 expected fail; took" in call("run", path, code=0).out
    answer = call("run", path, *ANOTHER, code=0)
    assert verdicts_in(answer.out) == {"slipping": "allowed fail"}
    assert "PASSED: 1 case: 1 allowed fail; allowed: slipping: locked-wheels " in answer.out
    call("run", path, *ANOTHER, "--strict", code=1)
    # The same, read back from the results alone.
    call("run", path, *ANOTHER, "--report", "junit,html", "-o", "runs")
    call("report", Path("runs/latest").resolve(), "--format", "junit,html", "-o", "again")
    assert Path("again/index.html").read_text("utf-8").count('<h1 class="tally-odd">') == 1
    root = ElementTree.parse("again/junit.xml").getroot()
    assert root.find("testsuite/testcase/failure") is None
    assert "allowed: slipping: locked-wheels " in (root.findtext("testsuite/testcase/system-out") or "")
    (case,) = results_of("runs/latest")["cases"]
    assert case["expect"] == {**yaml.safe_load(NAMED), "of_another_controller": True}


def test_what_is_missed_beyond_the_names_is_red_and_junit_says_by_how_much(call, slipping):
    path = slipping("{fail: [total-locked-time]}")
    call("run", path, "--junitxml", "junit.xml", code=1)
    message = ElementTree.parse("junit.xml").getroot().find("testsuite/testcase/failure").get("message")
    assert "locked-wheels " in message
    assert " s (limit 1 s), at " in message
    assert message.endswith("Expected: fail (total-locked-time)")


def test_a_better_controller_is_no_unexpected_pass_and_an_unnamed_failure_is_met_by_the_own_one_alone(
    call, slipping
):
    shown = call("run", slipping(NAMED, "threshold"), code=1).out
    assert verdicts_in(shown) == {"slipping": "unexpected pass"}
    another = ("--set", "controller=threshold")
    call("run", slipping(NAMED), *another, "--strict", code=0)
    path = slipping("fail")
    call("run", path, code=0)
    assert "names no criterion" in call("run", path, "--strict", "--format", "github", code=1).out
    call("run", path, *ANOTHER, code=1)


def test_what_is_suggested_is_met_when_it_is_pasted(call, slipping):
    answer = call("run", slipping("pass"), "--suggest-expect", code=1)
    place, line = answer.out.splitlines()[-2:]
    assert place == "# slipping.yaml"
    expect = yaml.safe_load(line)["expect"]
    assert LOCKED in expect["fail"]
    call("run", slipping(line.removeprefix("expect: ")), "--strict", code=0)
    # Where stdout is a document, lines to paste are messages.
    answer = call("run", slipping("pass"), "--suggest-expect", "--format", "json", code=1)
    json.loads(answer.out)
    assert line in answer.err.splitlines()


def test_the_first_controller_names_what_it_misses(call, workplace):
    call("init", "controller", "--python", "mine", code=0)
    (case,) = scenarios.load([Path("mine/slip-120.yaml")])
    assert case.scenario.expect.names_criteria


@pytest.mark.parametrize("controller", ["threshold", "slip-band"])
def test_the_rail_that_decides_is_the_same_for_every_controller(call, workplace, controller):
    """Whether a controller makes a slip test of its stop or not."""
    options = ("--set", f"controller={controller}", "--set", "rail.friction=0.05", "--set", "expect=pass")
    call("run", "cleaned-rail-120", *options, "--set", "test_validity=rail")
    case = _case()
    assert case["outcome"] in ("invalid", "fail")
    assert {each["id"]: each["verdict"] for each in case["rail"]["criteria"]}["initial-adhesion"] == "fail"


def test_quiet_does_not_hide_what_is_allowed(call, slipping):
    path = slipping(NAMED)
    assert verdicts_in(call("run", path, *ANOTHER, "-q", code=0).out) == {"slipping": "allowed fail"}
    assert call("run", path, "-q", code=0).out == ""


def test_a_stop_says_what_it_cannot_be_judged_by(call, workplace):
    err = call("run", "sanded-80", code=0).err
    assert "1 stop judged without distance-over-reference, no reference distance" in " ".join(err.split())
    assert max(map(len, err.splitlines())) <= 100
    drag = "drag={speed: 100 km/h, duration: 5 s}"
    answer = call("run", "slip-120", "--set", drag, code=1)
    assert verdicts_in(answer.out) == {"slip-120": "inconclusive"}
    assert "initial-adhesion: drag braking: traction holds 100 km/h" in answer.out
