"""Cases that are run as nobody asked otherwise."""

import os
import re
from pathlib import Path

from uictest import runs
from uictest.plans.scenario import load
from uictest.running.campaign import RecordingRequest, RunSettings, run_cases

from .test_acceptance import TURNING

HEAD = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 120 km/h\n"
TELLS_WHERE_IT_RUNS = """\
import os
class Own:
    def __init__(self, config): pass
    def reset(self): pass
    def step(self, inputs): raise ValueError(f"process {os.getpid()}")
"""


def result_of(text):
    """Run the one case of a scenario in the working folder."""
    path = Path("stop.yaml")
    path.write_text(text, "utf-8")
    batch = runs.batch_of(load([path]), [], ["run", "stop.yaml"], None)
    [result] = runs.run_batch(batch, runs.Observer()).content.results
    return result


def test_a_controller_from_outside_runs_in_a_process_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("own.py").write_text(TELLS_WHERE_IT_RUNS, "utf-8")
    result = result_of(HEAD + "controller: {python: own.py, class: Own}\n")
    told = re.search(r"process (\d+)", result.reason)
    assert told is not None, result.reason
    assert int(told[1]) != os.getpid()


def test_a_verdict_that_is_not_settled_meets_what_is_expected(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert result_of(TURNING).met


def test_what_strict_does_not_count_as_met_counts_for_maxfail(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("stop.yaml").write_text(TURNING, "utf-8")
    cases = load([Path("stop.yaml")], ["seed=0,1"])
    for strict, run in ((False, 2), (True, 1)):
        settings = RunSettings(recording=RecordingRequest("none"), maxfail=1, strict=strict)
        assert len(run_cases(cases, settings).results) == run
