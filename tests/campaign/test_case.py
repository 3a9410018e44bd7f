from types import SimpleNamespace

import pytest

import uictest.judging.evaluation
import uictest.rig
from uictest.controllers import ControllerError
from uictest.judging.evaluation import CaseResult
from uictest.running.campaign import RecordingRequest, Stop, run_stop

from .conftest import make_case


class Rig:
    """Stands in for the rig and the judgement: remembers how it was asked to record."""

    def __init__(self, outcome):
        self.outcome = outcome
        self.asked = []

    def simulate(self, case, record_every, run):
        self.asked.append(record_every)
        recording = None if record_every is None else f"every {record_every} s"
        made_up = {"measures": None, "wheelset_measures": None, "response_times": None}
        made_up |= {"coupler_ahead": None, "coupler_behind": None}
        return SimpleNamespace(
            **made_up,
            recording=recording,
            controller_version="wsp 1.2.0",
            controller_contract=2,
            case_sha256="ab" * 32,
            noise_key="00c0ffee",
            controller_output="",
        )

    def evaluate(self, case, measures, wheelsets, duration, *, detail, response_times, couplers):
        return CaseResult(case.id, "a.yaml", {}, case.scenario.expect, self.outcome, duration=duration)


@pytest.fixture
def make_rig(monkeypatch):
    def make(outcome):
        rig = Rig(outcome)
        monkeypatch.setattr(uictest.rig, "simulate", rig.simulate)
        monkeypatch.setattr(uictest.judging.evaluation, "evaluate_simulated", rig.evaluate)
        return rig

    return make


@pytest.mark.parametrize(
    ("wish", "outcome", "asked", "recording"),
    [
        (RecordingRequest("none"), "fail", [None], None),
        (RecordingRequest("all", every=0.02), "pass", [0.02], "every 0.02 s"),
        (RecordingRequest("failed"), "pass", [None], None),
        (RecordingRequest("failed", every=0.02), "fail", [None, 0.02], "every 0.02 s"),
    ],
)
def test_a_stop_is_simulated_again_only_for_the_recording_of_a_missed_case(
    make_rig, wish, outcome, asked, recording
):
    rig = make_rig(outcome)
    examined = run_stop(Stop(make_case("dry")), wish).case_run
    assert rig.asked == asked
    assert examined.recording == recording
    assert examined.result.outcome == outcome


@pytest.mark.parametrize(("outcome", "recording"), [("pass", None), ("fail", "every 0.02 s")])
def test_a_stop_with_a_controller_from_outside_is_never_repeated(make_rig, outcome, recording):
    """It may answer differently another time, and the recording would be of another stop."""
    rig, case = make_rig(outcome), make_case("dry")
    case.is_from_outside = True
    examined = run_stop(Stop(case), RecordingRequest("failed", every=0.02)).case_run
    assert (rig.asked, examined.recording) == ([0.02], recording)


def test_a_result_says_which_controller_answered_in_which_stop(make_rig):
    make_rig("pass")
    result = run_stop(Stop(make_case("dry")), RecordingRequest("none")).case_run.result
    told = result.controller_version, result.controller_contract, result.case_sha256
    assert told == ("wsp 1.2.0", 2, "ab" * 32)
    assert result.noise_key == "00c0ffee"


def test_a_stop_in_which_the_controller_failed_is_named_as_well(make_rig, monkeypatch):
    """A log of the controller has it, too, and is looked at first."""

    def crash(case, record_every, run):
        raise ControllerError("step failed: no memory (cycle 7)")

    make_rig("pass")
    monkeypatch.setattr(uictest.rig, "simulate", crash)
    monkeypatch.setattr(uictest.rig, "sha256_of_case", lambda case: "ab" * 32)
    result = run_stop(Stop(make_case("dry")), RecordingRequest("none")).case_run.result
    assert (result.outcome, result.reason) == ("error", "controller: step failed: no memory (cycle 7)")
    assert (result.controller_version, result.case_sha256) == ("", "ab" * 32)


def test_a_crash_of_one_case_is_its_result(make_rig, monkeypatch):
    def crash(case, record_every, run):
        raise ZeroDivisionError("no wheel load")

    make_rig("pass")
    monkeypatch.setattr(uictest.rig, "simulate", crash)
    examined = run_stop(Stop(make_case("dry")), RecordingRequest()).case_run
    result = examined.result
    assert (result.id, result.outcome, result.reason) == ("dry", "error", "ZeroDivisionError: no wheel load")
    assert not result.met
    assert "in crash" in examined.traceback
