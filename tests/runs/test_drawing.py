from types import SimpleNamespace

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import PASS
from uictest.report import DRAWN
from uictest.running import campaign
from uictest.running.campaign import CaseRun, RecordingRequest
from uictest.runs.batch import TraceCollection

RECORDING = Recording(
    {"time": np.array([0.0, 1.0]), "speed": np.array([2.0, 1.0])}, {"time": "s", "speed": "m/s"}
)


CYCLE = 0.01


def _cases(count):
    scenario = SimpleNamespace(controller=SimpleNamespace(cycle_time=CYCLE), repeat=1, seed=0)
    return [SimpleNamespace(id=f"case-{n}", scenario=scenario, train=None) for n in range(count)]


def _result(case_id, outcome="pass"):
    return CaseResult(case_id, "a.yaml", {}, PASS, outcome)


@pytest.fixture
def replayed(monkeypatch):
    """The ids of the cases that were simulated again, with their intervals of recording."""
    intervals = {}

    def replay(cases, every, jobs):
        intervals.update(dict.fromkeys((case.id for case in cases), every))
        return [(case, RECORDING) for case in cases]

    monkeypatch.setattr(campaign, "replay", replay)
    return intervals


def test_a_small_batch_is_recorded_as_it_runs_unless_that_is_too_coarse_for_the_valves(replayed):
    drawing = TraceCollection(_cases(2), RecordingRequest("none"), needed=True)
    assert drawing.recording.cases == "all"
    drawing.add(CaseRun(_result("case-0"), RECORDING))
    assert list(drawing.finish([_result("case-0")], jobs=1, interrupted=False)) == ["case-0"]
    assert replayed == {}
    drawing = TraceCollection(_cases(1), RecordingRequest("all", every=0.1), needed=True)
    assert drawing.recording.every == 0.1
    drawing.add(CaseRun(_result("case-0"), RECORDING))
    assert list(drawing.finish([_result("case-0")], jobs=1, interrupted=False)) == ["case-0"]
    assert replayed == {"case-0": CYCLE}


def test_of_a_large_batch_the_worst_or_those_chosen_are_simulated_again(replayed):
    cases = _cases(DRAWN + 5)
    drawing = TraceCollection(cases, RecordingRequest("failed"), needed=True)
    assert drawing.recording == RecordingRequest("failed")
    outcomes = ["pass"] * DRAWN + ["fail"] * 4 + ["error"]
    results = [_result(case.id, outcome) for case, outcome in zip(cases, outcomes, strict=True)]
    drawing.add(CaseRun(results[-2], RECORDING))
    assert len(drawing.finish(results, jobs=1, interrupted=False)) == DRAWN
    # Of those that failed one is recorded already, and an error has nothing to draw.
    assert {f"case-{DRAWN + n}" for n in range(4)} <= set(replayed)
    assert f"case-{DRAWN + 4}" not in replayed
    replayed.clear()
    cases = _cases(2 * DRAWN)
    chosen = {case.id for case in cases[DRAWN - 2 :]}
    drawing = TraceCollection(cases, RecordingRequest("failed"), needed=True, drawn_first=chosen)
    results = [_result(case.id, "fail" if case.id not in chosen else "pass") for case in cases]
    assert drawing.finish(results, jobs=1, interrupted=False).keys() == chosen == set(replayed)


@pytest.mark.parametrize(("wanted", "interrupted"), [(False, False), (True, True)])
def test_nothing_is_drawn_unasked_or_after_an_interrupt(replayed, wanted, interrupted):
    drawing = TraceCollection(_cases(DRAWN + 1), RecordingRequest("failed"), needed=wanted)
    assert drawing.finish([_result("case-0")], jobs=1, interrupted=interrupted) == {}
    assert replayed == {}
    assert TraceCollection(_cases(1), RecordingRequest("failed"), needed=False).recording.cases == "failed"
