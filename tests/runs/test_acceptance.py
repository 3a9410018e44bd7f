"""Runs of series and of cases as nobody asked otherwise: what they may not pass."""

import os
import re
from pathlib import Path

import pytest

import uictest
from uictest import runs
from uictest.plans.scenario import load
from uictest.running.campaign import RecordingRequest, RunSettings, run_cases

SCENARIOS = Path(__file__).parents[2] / "scenarios"
CLEANED = "  - {scenario: cleaned-rail-120.yaml, set: {rail.friction: [0.09, 0.10]}}\n"
UNCLEANED = "  - {scenario: slip-120.yaml, set: {rail.friction: 0.09}}\n"
SERIES = """\
schema: uictest/series/1
name: acceptance
repeat: 3
set: {{criteria: uictest-stop, rig.compensation: thermal}}
dry: {{scenario: dry-120.yaml, repeat: 2}}
wet:
{wet}criteria: uictest-wsp
"""
NEVER_SOUNDS = {"extends": "threshold", "sounding_interval": "20 s"}
"""A controller that hardly ever lets a wheelset roll to look at the speed of the train."""


@pytest.fixture
def accept(tmp_path):
    """Judge a controller by a series of these wet stops."""

    def judged(wet, controller):
        for name in ("dry-120", "cleaned-rail-120", "slip-120"):
            (tmp_path / f"{name}.yaml").write_text((SCENARIOS / f"{name}.yaml").read_text("utf-8"), "utf-8")
        path = tmp_path / "acceptance.series.yaml"
        path.write_text(SERIES.format(wet=wet), "utf-8")
        (result,) = uictest.run(path, set={"controller": controller}).series
        return result

    return judged


def test_a_controller_that_loses_every_uncleaned_stop_is_not_accepted(accept):
    """It keeps every limit where sliding grinds the rail clean, and locks wheels wherever it does not."""
    assert accept(CLEANED, NEVER_SOUNDS).met
    both = accept(CLEANED + UNCLEANED, NEVER_SOUNDS)
    missed = {each.verdict.id for each in both.criteria if each.verdict.status == "fail"}
    assert not both.met
    assert "passing-stops" in missed
    uncleaned = next(each for each in both.speeds if each.rail == "uncleaned")
    assert uncleaned.measures["passing_share"].estimate.value <= 10.0


def test_a_series_says_where_locked_wheels_have_the_better_k_wet(accept):
    result = accept(CLEANED + UNCLEANED, "threshold")
    tested = next(each for each in result.criteria if each.verdict.id == "k-wet").estimate
    assert result.met
    assert result.bypassed_k_wet.estimate.value > tested.value
    assert result.bypassed_k_wet.estimate.stops == tested.stops == 6


UNJUDGED = """\
schema: uictest/scenario/1
name: too-fast
initial_speed: 160 km/h
rail: {condition: wet, friction: 0.05}
rig: {wsp: bypassed, compensation: thermal}
criteria: uic-541-05-appendix-b
"""
TURNING = """\
schema: uictest/scenario/1
name: turning
initial_speed: 120 km/h
rail: {condition: wet, friction: 0.09}
rig: {compensation: thermal}
criteria:
  schema: uictest/criteria/1
  name: own
  criteria:
    - id: slides-deeply
      layer: validity
      measure: maximum_slide_above_cutoff
      wheelsets: any
      lower: 50 %
      definition: {low_speed_cutoff: {value: 60 km/h, range: [10 km/h, 60 km/h]}}
expect: invalid
"""


def test_a_stop_that_no_criterion_judges_is_not_met(tmp_path):
    """All wheels locked over four kilometres, and the one profile says nothing about such a stop."""
    path = tmp_path / "too-fast.yaml"
    path.write_text(UNJUDGED, "utf-8")
    results = uictest.run(path)
    assert (results[0].outcome, results.met) == ("skipped", False)
    path.write_text(f"{UNJUDGED}expect: skipped\n", "utf-8")
    assert uictest.run(path).met


def test_a_verdict_that_turns_meets_nothing_where_strictness_is_asked_for(tmp_path):
    path = tmp_path / "turning.yaml"
    path.write_text(TURNING, "utf-8")
    assert uictest.run(path).met
    strict = uictest.run(path, strict=True)
    assert not strict.met
    assert [verdict.id for verdict in strict[0].unsettled] == ["slides-deeply"]


OUTSIDE = """\
schema: uictest/scenario/1
name: stop
initial_speed: 120 km/h
controller: {python: own.py, class: Own}
"""
TELLS_WHERE_IT_RUNS = """\
import os
class Own:
    def __init__(self, config): pass
    def reset(self): pass
    def step(self, inputs): raise ValueError(f"process {os.getpid()}")
"""


def test_a_controller_from_outside_runs_in_a_process_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("own.py").write_text(TELLS_WHERE_IT_RUNS, "utf-8")
    Path("stop.yaml").write_text(OUTSIDE, "utf-8")
    batch = runs.batch_of(load([Path("stop.yaml")]), [], ["run", "stop.yaml"], None)
    [result] = runs.run_batch(batch, runs.Observer()).content.results
    told = re.search(r"process (\d+)", result.reason)
    assert told is not None, result.reason
    assert int(told[1]) != os.getpid()


def test_what_strict_does_not_count_as_met_counts_for_maxfail(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("stop.yaml").write_text(TURNING, "utf-8")
    cases = load([Path("stop.yaml")], ["seed=0,1"])
    for strict, run in ((False, 2), (True, 1)):
        settings = RunSettings(recording=RecordingRequest("none"), maxfail=1, strict=strict)
        assert len(run_cases(cases, settings).results) == run
