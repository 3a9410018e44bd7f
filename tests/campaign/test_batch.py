from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import pytest

from uictest.judging.evaluation import CaseResult, error_result
from uictest.running.campaign import (
    BatchResult,
    CaseRun,
    RecordingRequest,
    RunSettings,
    StopRun,
    batch,
    run_cases,
)

MakeCase = Callable[..., Any]
Examine = Callable[[Any, RecordingRequest, Any], CaseRun]


def _result(case: Any) -> CaseResult:
    outcome = "fail" if "fail" in case.scenario.tags else "pass"
    return CaseResult(case.id, case.path.as_posix(), {}, case.scenario.expect, outcome)  # type: ignore[arg-type]


def _ids(campaign: BatchResult) -> list[str]:
    return [result.id for result in campaign.results]


@pytest.fixture
def examined_by(monkeypatch: pytest.MonkeyPatch) -> Callable[[Examine], None]:
    return lambda examine: monkeypatch.setattr(
        batch, "run_stop", lambda stop, wish, run: StopRun(stop, examine(stop.case, wish, run))
    )


@pytest.mark.parametrize("jobs", [1, 2, 7])
def test_results_come_in_the_order_of_the_cases(
    make_case: MakeCase, examined_by: Callable[[Examine], None], jobs: int
) -> None:
    cases = [make_case(f"case-{number}") for number in range(30)]

    def uneven(case: Any, wish: RecordingRequest, run: object) -> CaseRun:
        time.sleep(0.004 if case.id.endswith("0") else 0.0)
        return CaseRun(_result(case))

    examined_by(uneven)
    seen: list[str] = []
    campaign = run_cases(
        cases, RunSettings(jobs=jobs), on_result=lambda examined: seen.append(examined.result.id)
    )
    assert _ids(campaign) == seen == [case.id for case in cases]
    assert not campaign.interrupted


@pytest.mark.parametrize("jobs", [1, 4])
def test_what_maxfail_leaves_does_not_depend_on_the_number_of_threads(
    make_case: MakeCase, examined_by: Callable[[Examine], None], jobs: int
) -> None:
    examined_by(lambda case, wish, run: CaseRun(_result(case)))
    cases = [make_case(str(number), *(["fail"] if number % 3 == 2 else [])) for number in range(20)]
    assert _ids(run_cases(cases, RunSettings(jobs=jobs, maxfail=2))) == ["0", "1", "2", "3", "4", "5"]


def test_an_expected_failure_does_not_count(
    make_case: MakeCase, examined_by: Callable[[Examine], None]
) -> None:
    examined_by(lambda case, wish, run: CaseRun(_result(case)))
    cases = [make_case(str(number), "fail", expect="fail") for number in range(3)]
    assert len(run_cases(cases, RunSettings(maxfail=1)).results) == 3


def test_an_interrupt_keeps_what_is_finished_and_waits_for_nothing(
    make_case: MakeCase, examined_by: Callable[[Examine], None]
) -> None:
    released = threading.Event()

    def examine(case: Any, wish: RecordingRequest, run: object) -> CaseRun:
        if case.id == "long":
            released.wait(60.0)
        return CaseRun(_result(case))

    def interrupt(examined: CaseRun) -> None:
        if examined.result.id == "second":
            raise KeyboardInterrupt

    examined_by(examine)
    cases = [make_case(name) for name in ("first", "second", "long", "never")]
    try:
        campaign = run_cases(cases, RunSettings(jobs=1), on_result=interrupt)
    finally:
        released.set()
    assert campaign.interrupted
    assert _ids(campaign) == ["first", "second"]


def test_an_error_of_the_caller_goes_on(make_case: MakeCase, examined_by: Callable[[Examine], None]) -> None:
    def full(examined: CaseRun) -> None:
        raise OSError("No space left on device")

    examined_by(lambda case, wish, run: CaseRun(_result(case)))
    with pytest.raises(OSError, match="No space left"):
        run_cases([make_case("first"), make_case("second")], on_result=full)


def test_few_cases_are_examined_ahead_of_the_one_awaited(
    make_case: MakeCase, examined_by: Callable[[Examine], None]
) -> None:
    started: list[str] = []

    def examine(case: Any, wish: RecordingRequest, run: object) -> CaseRun:
        started.append(case.id)
        return CaseRun(error_result(case, "made up"))

    examined_by(examine)
    run_cases([make_case(str(number)) for number in range(1000)], RunSettings(jobs=2, maxfail=1))
    assert len(started) < 20
