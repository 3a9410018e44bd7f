from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.judging.evaluation import CaseResult
from uictest.report import DRAWN
from uictest.running import campaign
from uictest.running.campaign import BatchResult, CaseRun, RecordingRequest
from uictest.runs.drawing import TraceCollection

RECORDING = Recording(
    {"time": np.array([0.0, 1.0]), "speed": np.array([2.0, 1.0])}, {"time": "s", "speed": "m/s"}
)


CYCLE = 0.01


def _cases(count: int) -> list[Any]:
    scenario = SimpleNamespace(controller=SimpleNamespace(cycle_time=CYCLE))
    return [SimpleNamespace(id=f"case-{n}", scenario=scenario) for n in range(count)]


def _result(case_id: str, outcome: str = "pass") -> CaseResult:
    return CaseResult(case_id, "a.yaml", {}, "pass", outcome)  # type: ignore[arg-type]


@pytest.fixture
def replayed(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The ids of the cases that were simulated again."""
    ids: list[str] = []

    def replay(cases: Sequence[Any], every: float, jobs: int) -> Any:
        ids.extend(case.id for case in cases)
        return [(case, RECORDING) for case in cases]

    monkeypatch.setattr(campaign, "replay", replay)
    return ids


def test_a_small_batch_is_recorded_as_it_runs(replayed: list[str]) -> None:
    drawing = TraceCollection(_cases(2), RecordingRequest("none"), needed=True)
    assert drawing.recording.cases == "all"
    drawing.add(CaseRun(_result("case-0"), RECORDING))
    assert list(drawing.finish(BatchResult([_result("case-0")]), jobs=1)) == ["case-0"]
    assert replayed == []


def test_of_a_large_batch_the_worst_are_simulated_again(replayed: list[str]) -> None:
    cases = _cases(DRAWN + 5)
    drawing = TraceCollection(cases, RecordingRequest("failed"), needed=True)
    assert drawing.recording == RecordingRequest("failed")
    outcomes = ["pass"] * DRAWN + ["fail"] * 4 + ["error"]
    results = [_result(case.id, outcome) for case, outcome in zip(cases, outcomes, strict=True)]
    drawing.add(CaseRun(results[-2], RECORDING))
    assert len(drawing.finish(BatchResult(results), jobs=1)) == DRAWN
    assert {f"case-{DRAWN + n}" for n in range(4)} <= set(replayed)
    assert f"case-{DRAWN + 4}" not in replayed


def test_chosen_cases_of_a_large_batch_are_simulated_again(replayed: list[str]) -> None:
    cases = _cases(2 * DRAWN)
    chosen = {case.id for case in cases[DRAWN - 2 :]}
    drawing = TraceCollection(cases, RecordingRequest("failed"), needed=True, chosen=chosen)
    results = [_result(case.id, "fail" if case.id not in chosen else "pass") for case in cases]
    assert drawing.finish(BatchResult(results), jobs=1).keys() == chosen == set(replayed)


def test_a_recording_too_coarse_for_the_valves_is_not_what_a_page_draws(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    intervals = []

    def replay(cases: Sequence[Any], every: float, jobs: int) -> Any:
        intervals.append(every)
        return [(case, RECORDING) for case in cases]

    monkeypatch.setattr(campaign, "replay", replay)
    drawing = TraceCollection(_cases(1), RecordingRequest("all", every=0.1), needed=True)
    assert drawing.recording.every == 0.1
    drawing.add(CaseRun(_result("case-0"), RECORDING))
    assert list(drawing.finish(BatchResult([_result("case-0")]), jobs=1)) == ["case-0"]
    assert intervals == [CYCLE]


@pytest.mark.parametrize(("wanted", "interrupted"), [(False, False), (True, True)])
def test_nothing_is_drawn_unasked_or_after_an_interrupt(
    replayed: list[str], wanted: bool, interrupted: bool
) -> None:
    drawing = TraceCollection(_cases(DRAWN + 1), RecordingRequest("failed"), needed=wanted)
    assert drawing.finish(BatchResult([_result("case-0")], interrupted=interrupted), jobs=1) == {}
    assert replayed == []
    assert TraceCollection(_cases(1), RecordingRequest("failed"), needed=False).recording.cases == "failed"


def test_a_recording_made_for_the_page_alone_is_not_kept() -> None:
    wish = RecordingRequest("failed")
    assert wish.wants(_result("a", "fail"))
    assert not wish.wants(_result("a"))
    assert RecordingRequest("all").wants(_result("a"))
    assert not RecordingRequest("none").wants(_result("a", "fail"))
