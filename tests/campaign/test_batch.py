import threading
import time

import pytest

from uictest.judging.evaluation import CaseResult, error_result
from uictest.running.campaign import (
    CaseRun,
    RunSettings,
    StopRun,
    run_cases,
    train_blocks,
)


def _result(case):
    outcome = "fail" if "fail" in case.scenario.tags else "pass"
    return CaseResult(case.id, case.path.as_posix(), {}, case.scenario.expect, outcome)


def _ids(campaign):
    return [result.id for result in campaign.results]


@pytest.fixture
def examined_by(monkeypatch):
    return lambda examine: monkeypatch.setattr(
        train_blocks, "run_stop", lambda stop, wish, run: StopRun(stop, examine(stop.case, wish, run))
    )


@pytest.mark.parametrize("jobs", [1, 2, 7])
def test_results_come_in_the_order_of_the_cases(make_case, examined_by, jobs):
    cases = [make_case(f"case-{number}") for number in range(30)]

    def uneven(case, wish, run):
        time.sleep(0.004 if case.id.endswith("0") else 0.0)
        return CaseRun(_result(case))

    examined_by(uneven)
    seen = []
    campaign = run_cases(
        cases, RunSettings(jobs=jobs), on_case=lambda examined: seen.append(examined.result.id)
    )
    assert _ids(campaign) == seen == [case.id for case in cases]
    assert not campaign.interrupted


@pytest.mark.parametrize("jobs", [1, 4])
def test_what_maxfail_leaves_does_not_depend_on_the_number_of_threads(make_case, examined_by, jobs):
    examined_by(lambda case, wish, run: CaseRun(_result(case)))
    cases = [make_case(str(number), *(["fail"] if number % 3 == 2 else [])) for number in range(20)]
    assert _ids(run_cases(cases, RunSettings(jobs=jobs, maxfail=2))) == ["0", "1", "2", "3", "4", "5"]


def test_an_expected_failure_does_not_count(make_case, examined_by):
    examined_by(lambda case, wish, run: CaseRun(_result(case)))
    cases = [make_case(str(number), "fail", expect="fail") for number in range(3)]
    assert len(run_cases(cases, RunSettings(maxfail=1)).results) == 3


def test_an_interrupt_keeps_what_is_finished_and_waits_for_nothing(make_case, examined_by):
    released = threading.Event()

    def examine(case, wish, run):
        if case.id == "long":
            released.wait(60.0)
        return CaseRun(_result(case))

    def interrupt(examined):
        if examined.result.id == "second":
            raise KeyboardInterrupt

    examined_by(examine)
    cases = [make_case(name) for name in ("first", "second", "long", "never")]
    try:
        campaign = run_cases(cases, RunSettings(jobs=1), on_case=interrupt)
    finally:
        released.set()
    assert campaign.interrupted
    assert _ids(campaign) == ["first", "second"]


def test_a_case_is_handed_on_where_an_interrupt_ends_the_question_how_firm_it_is(make_case, examined_by):
    def interrupt(case_id):
        raise KeyboardInterrupt

    examined_by(lambda case, wish, run: CaseRun(_result(case)))
    seen = []
    campaign = run_cases(
        [make_case("first"), make_case("second")],
        RunSettings(jobs=1, firmness=interrupt),
        on_case=lambda examined: seen.append(examined.result.id),
    )
    assert campaign.interrupted
    assert _ids(campaign) == seen
    assert seen[0] == "first"


def test_an_error_of_the_caller_goes_on(make_case, examined_by):
    def full(examined):
        raise OSError("No space left on device")

    examined_by(lambda case, wish, run: CaseRun(_result(case)))
    with pytest.raises(OSError, match="No space left"):
        run_cases([make_case("first"), make_case("second")], on_case=full)


def test_few_cases_are_examined_ahead_of_the_one_awaited(make_case, examined_by):
    started = []

    def examine(case, wish, run):
        started.append(case.id)
        return CaseRun(error_result(case, "made up"))

    examined_by(examine)
    run_cases([make_case(str(number)) for number in range(1000)], RunSettings(jobs=2, maxfail=1))
    assert len(started) < 20
