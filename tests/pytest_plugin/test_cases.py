"""One item per case: outcomes, messages, selection."""

import json
import re
from pathlib import Path

import pytest

from uictest import report
from uictest.plans.scenario import load
from uictest.running.campaign import run_cases

from ..runs.test_acceptance import TURNING
from .conftest import SHORT_STOPS, in_process_of_its_own, junit_testcases, properties

BROKEN = """\
class Broken:
    def __init__(self, config): pass
    def reset(self): pass
    def step(self, inputs): raise ValueError("no idea")
"""


@pytest.fixture
def five(scenario, write):
    """Scenarios with every outcome."""
    write("short-stops.yaml", SHORT_STOPS)
    write("broken.py", BROKEN)
    scenario("full", "tags: [dry, uic-541-05, skip]\nrequirements: [BR-1]\ntest_case: TC-7\n")
    scenario("weak", "tags: [dry]\ncriteria: ../short-stops.yaml\nmatrix: {brake.command: [80 %, 100 %]}\n")
    scenario("known", "criteria: ../short-stops.yaml\nbrake: {command: 80 %}\nexpect: fail\n")
    scenario("crash", "controller: {python: ../broken.py, class: Broken}\n")
    scenario("dry", "criteria: uic-541-05-appendix-b\nexpect: skipped\n")


@pytest.mark.usefixtures("five")
@pytest.mark.parametrize("workers", [[], ["-p", "xdist", "-n", "2"]], ids=["alone", "xdist"])
def test_outcomes(run, workers):
    done = run("-rs", "--junitxml", "junit.xml", *workers)
    assert done.code == 1
    assert done.summary == "1 failed, 3 passed, 1 skipped, 1 error"
    assert any("distance (requirement) fail:" in line for line in done.lines)
    found = junit_testcases(Path("junit.xml"))
    # The tag `skip` of the first one is a word to select it by, not an order to pytest.
    tags = {name: [child.tag for child in each if child.tag != "properties"] for name, each in found.items()}
    assert tags == {
        "full": [],
        "weak[command=80]": ["failure"],
        "weak[command=100]": [],
        "known": [],
        "crash": ["error"],
        "dry": ["skipped"],
    }
    assert "Traceback" not in "\n".join(done.lines)
    assert any(line.startswith("SKIPPED [1] scenarios/dry.yaml:1: initial-adhesion:") for line in done.lines)
    assert "ValueError: no idea" in str(found["crash"].findtext("error"))


@pytest.mark.usefixtures("five")
def test_a_missed_expectation_reads_as_in_the_report_of_the_command(run):
    [result] = run_cases(load([Path("scenarios/weak.yaml")], ["brake.command=80 %"])).results
    done = run("scenarios/weak.yaml::weak[command=80]")
    outcome, reason = report.explanation(result)
    place = done.lines.index(reason)
    assert done.lines[place + 1] == outcome
    assert outcome.endswith(". Expected: pass")
    assert done.summary == "1 failed"


@pytest.mark.usefixtures("five")
def test_figures_and_test_ids_are_properties(run):
    [result] = run_cases(load([Path("scenarios/full.yaml")])).results
    run("-k", "full or weak", "--junitxml", "junit.xml")
    found = {name: properties(each) for name, each in junit_testcases(Path("junit.xml")).items()}
    ids = {"polarion-testcase-id": "TC-7", "test_key": "TC-7", "requirements": "BR-1"}
    assert found["full"].items() >= ids.items()
    assert found["weak[command=100]"]["requirements"] == "BR-2"
    assert float(found["full"]["braking_distance_m"]) == pytest.approx(
        result.measures["braking_distance_m"], rel=1e-4
    )
    assert "initial_adhesion_g" not in found["full"]  # nothing slid


@pytest.mark.usefixtures("five")
@pytest.mark.parametrize(
    ("arguments", "selected"),
    [
        (["-k", "weak and 80"], ["weak.yaml::weak[command=80]"]),
        (["-k", "uic-541"], ["full.yaml::full"]),
        (["-m", "uic-541-05 and dry"], ["full.yaml::full"]),
        (["scenarios/weak.yaml::weak"], ["weak.yaml::weak[command=80]", "weak.yaml::weak[command=100]"]),
        (["scenarios/weak.yaml::weak[command=100]"], ["weak.yaml::weak[command=100]"]),
    ],
)
def test_selection(run, arguments, selected):
    done = run("--collect-only", "-q", "--strict-markers", *arguments)
    assert done.code == 0
    assert done.node_ids == [f"scenarios/{name}" for name in selected]


@pytest.mark.usefixtures("five")
def test_x_and_lf(run):
    assert run("-x", "-k", "known or weak").summary == "1 failed, 1 passed, 3 deselected"
    lines = run("--lf", "--collect-only", "-q").node_ids
    assert lines == ["scenarios/weak.yaml::weak[command=80]"]


def test_a_stop_that_nothing_judged_fails(run, scenario):
    scenario("unjudged", "criteria: uic-541-05-appendix-b\n")
    done = run()
    assert done.summary == "1 failed"
    assert any("skipped. Expected: pass" in line for line in done.lines)


def test_options_change_every_scenario(run, scenario):
    scenario("stop", "rail: {condition: wet, friction: 0.05}\n")
    options = ["--uictest-set", "brake.command=80 %,90 %", "--uictest-seed", "7", "--uictest-repeat", "2"]
    assert run("--collect-only", "-q", *options).node_ids == [
        "scenarios/stop.yaml::stop[command=80]",
        "scenarios/stop.yaml::stop[command=90]",
    ]
    run("-k", "90", "--junitxml", "junit.xml", *options)
    cases = load([Path("scenarios/stop.yaml")], ["brake.command=90 %", "repeat=2"], seed=7)
    [result] = run_cases(cases).results
    [testcase] = junit_testcases(Path("junit.xml")).values()
    assert properties(testcase)["braking_time_s"] == report.number(result.measures["braking_time_s"])


def test_a_verdict_that_is_not_settled_fails_where_strictness_is_asked_for(run, write):
    as_requirement = TURNING.replace("layer: validity", "layer: requirement")
    write("scenarios/turning.yaml", as_requirement.replace("expect: invalid", "expect: fail"))
    assert run().summary == "1 passed"
    strict = run("--uictest-strict", "--uictest-output", "out")
    assert strict.summary == "1 failed"
    assert any("slides-deeply" in line for line in strict.lines)
    command = json.loads(Path("out/latest/manifest.json").read_text("utf-8"))["command"]
    assert command[-1] == "--strict"


def test_an_invalid_file_is_an_error_of_collection_with_its_place(run, scenario):
    scenario("good")
    scenario("bad", "brake: {command: 200 %}\nrail: {friction: 0,1}\n")
    done = run()
    assert done.code == 2
    assert "ERROR scenarios/bad.yaml" in done.lines
    text = "\n".join(done.lines)
    excerpt = r"    4 \| brake: {command: 200 %}\n      \|                  \^"
    assert re.search(rf"^scenarios/bad\.yaml:4:18:.*\n{excerpt}", text, re.MULTILINE)
    assert "\nscenarios/bad.yaml:5:" in text
    assert "Traceback" not in text


def test_an_option_that_is_wrong_or_has_no_effect_is_an_error_of_usage(run, scenario):
    scenario("stop")
    wrong = run("--uictest-set", "seed")
    assert wrong.code == pytest.ExitCode.USAGE_ERROR
    assert any("'seed' is not a key and a value" in line for line in wrong.lines)
    options = ("set=rail.friction=0.06", "seed=0", "repeat=1", "strict", "output=out")
    for option in (f"--uictest-{each}" for each in options):
        outcome = run("-o", "uictest_files=", option)
        assert outcome.code == pytest.ExitCode.USAGE_ERROR
        assert f"{option.partition('=')[0]} has no effect" in "\n".join(outcome.lines)


def test_references_may_lead_anywhere_below_the_root(run, write, scenario, monkeypatch):
    write("short-stops.yaml", SHORT_STOPS)
    path = scenario("stop", "criteria: ../short-stops.yaml\n")
    monkeypatch.chdir(path.parent)
    assert run("stop.yaml").summary == "1 passed"


def test_a_run_that_asks_for_no_scenario_loads_nothing(write, scenario):
    scenario("stop")
    write("pytest.ini", "[pytest]\n")
    names = ["numpy", "pydantic", "numba", "yaml", "typer", "uictest.plans.scenario", "uictest.rig"]
    own = f"assert [name for name in {json.dumps(names)} if name in sys.modules] == []"
    write("test_own.py", f"import sys\ndef test_own(): {own}\n")
    assert in_process_of_its_own().summary == "1 passed"
