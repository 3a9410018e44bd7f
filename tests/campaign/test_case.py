"""One stop of a case: when it is recorded, who answered, and the words for it."""

from types import SimpleNamespace

import pytest

import uictest.judging.evaluation
import uictest.rig
from uictest.controllers import ControllerError
from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import load
from uictest.report.run_folder import read_subjects, subjects_form
from uictest.running.campaign import RecordingRequest, Stop, descriptions_of, run_stop

from .conftest import make_case

STOP = SimpleNamespace(
    **dict.fromkeys(["measures", "wheelset_measures", "response_times", "coupler_ahead", "coupler_behind"]),
    controller_version="wsp 1.2.0",
    controller_contract=2,
    case_sha256="ab" * 32,
    noise_key="00c0ffee",
    controller_output="",
)


@pytest.fixture
def make_rig(monkeypatch):
    """Put a rig and a judgement of one outcome in place of ours; returns the intervals it is asked for."""

    def make(outcome):
        asked = []

        def simulate(case, record_every, run):
            asked.append(record_every)
            recording = None if record_every is None else f"every {record_every} s"
            return SimpleNamespace(**vars(STOP), recording=recording)

        def evaluate(case, measures, wheelsets, duration, **options):
            return CaseResult(case.id, "a.yaml", {}, case.scenario.expect, outcome, duration=duration)

        monkeypatch.setattr(uictest.rig, "simulate", simulate)
        monkeypatch.setattr(uictest.judging.evaluation, "evaluate_simulated", evaluate)
        return asked

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
    intervals = make_rig(outcome)
    examined = run_stop(Stop(make_case("dry")), wish).case_run
    assert intervals == asked
    assert examined.recording == recording
    assert examined.result.outcome == outcome


@pytest.mark.parametrize(("outcome", "recording"), [("pass", None), ("fail", "every 0.02 s")])
def test_a_stop_with_a_controller_from_outside_is_never_repeated(make_rig, outcome, recording):
    """It may answer differently another time, and the recording would be of another stop."""
    asked, case = make_rig(outcome), make_case("dry")
    case.is_from_outside = True
    examined = run_stop(Stop(case), RecordingRequest("failed", every=0.02)).case_run
    assert (asked, examined.recording) == ([0.02], recording)


def test_a_result_says_which_controller_answered_in_which_stop(make_rig):
    make_rig("pass")
    result = run_stop(Stop(make_case("dry")), RecordingRequest("none")).case_run.result
    told = result.controller_version, result.controller_contract, result.case_sha256
    assert told == ("wsp 1.2.0", 2, "ab" * 32)
    assert result.noise_key == "00c0ffee"


@pytest.mark.parametrize(
    ("error", "reason", "named"),
    [
        # A log of the controller has the stop, too, and is looked at first.
        (ControllerError("step failed: no memory"), "controller: step failed: no memory", "ab" * 32),
        (ZeroDivisionError("no wheel load"), "ZeroDivisionError: no wheel load", ""),
    ],
)
def test_a_crash_of_one_case_is_its_result_and_one_of_the_controller_names_the_stop(
    make_rig, monkeypatch, error, reason, named
):
    def crash(case, record_every, run):
        raise error

    make_rig("pass")
    monkeypatch.setattr(uictest.rig, "simulate", crash)
    monkeypatch.setattr(uictest.rig, "sha256_of_case", lambda case: "ab" * 32)
    examined = run_stop(Stop(make_case("dry")), RecordingRequest("none")).case_run
    result = examined.result
    assert (result.id, result.outcome, result.reason) == ("dry", "error", reason)
    assert (result.met, result.controller_version, result.case_sha256) == (False, "", named)
    assert "in crash" in examined.traceback


_TEXT = "schema: uictest/scenario/1\nname: stop\ntitle: A stop\ntags: [a, b]\ninitial_speed: 80 km/h\n"


def _subject(tmp_path, text=""):
    path = tmp_path / "stop.yaml"
    path.write_text(_TEXT + text)
    return descriptions_of(load([path]))["stop"]


def test_a_subject_is_in_the_users_words(tmp_path):
    subject = _subject(tmp_path, "rail: {condition: wet, friction: 0.10}\n")
    assert (subject.title, subject.tags) == ("A stop", ("a", "b"))
    assert subject.settings["initial speed"] == "80 km/h"
    assert subject.settings["rail"] == "wet, friction 0.10, gradient 0 permille"
    assert read_subjects({"subjects": subjects_form({"a": subject})}) == {"a": subject}


@pytest.mark.parametrize(
    ("friction", "shown"),
    [
        ("", "dry, friction 0.55, "),
        ("  friction: {points: [{position: 0 m, friction: 0.3}]}\n", "dry, friction along the track, "),
        (
            "  friction: 0.2\n  friction_over_time: {points: [{time: 0 s, factor: 1}]}\n",
            "dry, friction 0.2, changing with time, ",
        ),
    ],
)
def test_friction_is_a_number_a_course_or_the_condition_s_own(tmp_path, friction, shown):
    assert _subject(tmp_path, f"rail:\n  condition: dry\n{friction}").settings["rail"].startswith(shown)
