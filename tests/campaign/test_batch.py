"""Cases on threads: in order, interrupted, replayed, described."""

import threading
import time
from types import SimpleNamespace

import pytest

import uictest.rig
from uictest.judging.evaluation import CaseResult, error_result
from uictest.running.campaign import (
    CaseRun,
    RunSettings,
    StopRun,
    ThreadedMap,
    map_on_threads,
    replay,
    run_cases,
    stop as stop_module,
)

from .conftest import make_case


def late_first(number):
    time.sleep(0.02 if number == 0 else 0.0)
    return number


@pytest.mark.parametrize("jobs", [1, 2, 5])
def test_results_come_in_the_order_of_the_arguments(jobs):
    assert list(map_on_threads(late_first, range(30), jobs=jobs)) == list(range(30))
    assert list(map_on_threads(late_first, [], jobs=jobs)) == []


@pytest.mark.parametrize(("pending", "most"), [(3, 3), (None, 8)])
def test_no_more_calls_are_submitted_than_stated(pending, most):
    taken = 0

    def arguments():
        nonlocal taken
        for number in range(40):
            taken += 1
            yield number

    with ThreadedMap(late_first, arguments(), jobs=2, pending=pending) as results:
        assert taken == most
        for returned, _ in enumerate(results, start=1):
            assert taken == min(most + returned, 40)


def test_an_exception_is_raised_where_its_result_would_be_returned():
    def fail_at_two(number):
        if number == 2:
            raise ZeroDivisionError
        return number

    results = []
    with pytest.raises(ZeroDivisionError):
        results.extend(map_on_threads(fail_at_two, range(9), jobs=3))
    results.clear()
    with pytest.raises(ZeroDivisionError), ThreadedMap(fail_at_two, range(9), jobs=3) as calls:
        results += calls
    assert results == [0, 1]


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError])
def test_an_error_of_the_caller_waits_for_nothing_and_loses_no_result(error):
    released, started = threading.Event(), []

    def work(number):
        started.append(number)
        if number == 3:
            released.wait(60.0)
        return number

    calls = ThreadedMap(work, range(20), jobs=1, pending=8)
    results = []
    try:
        with pytest.raises(error), calls:
            for number in calls:
                if number == 1:
                    raise error
                results.append(number)
        while len(started) < 4:
            time.sleep(0.001)
        assert results == [0]
        assert list(calls.finished()) == [2]
    finally:
        released.set()
    time.sleep(0.01)
    assert started == [0, 1, 2, 3]


def test_leaving_early_starts_nothing_more_and_waits_for_what_runs():
    ended = []

    def work(number):
        time.sleep(0.005)
        ended.append(number)
        return number

    with ThreadedMap(work, range(100), jobs=2) as results:
        first = next(iter(results))
    count = len(ended)
    time.sleep(0.03)
    assert first == 0
    assert len(ended) == count < 20


def _result(case):
    outcome = "fail" if "fail" in case.scenario.tags else "pass"
    return CaseResult(case.id, case.path.as_posix(), {}, case.scenario.expect, outcome)


def _ids(campaign):
    return [result.id for result in campaign.results]


@pytest.fixture
def examined_by(monkeypatch):
    return lambda examine: monkeypatch.setattr(
        stop_module, "run_stop", lambda stop, wish, run: StopRun(stop, examine(stop.case, wish, run))
    )


@pytest.mark.parametrize("jobs", [1, 2, 7])
def test_results_come_in_the_order_of_the_cases(examined_by, jobs):
    cases = [make_case(f"case-{number}") for number in range(30)]

    def uneven(case, wish, run):
        time.sleep(0.004 if case.id.endswith("0") else 0.0)
        return CaseRun(_result(case))

    examined_by(uneven)
    runs = []
    campaign = run_cases(cases, RunSettings(jobs=jobs), on_case=runs.append)
    seen = [run.result.id for run in runs]
    assert _ids(campaign) == seen == [case.id for case in cases]
    assert not campaign.interrupted


@pytest.mark.parametrize("jobs", [1, 4])
def test_what_maxfail_leaves_does_not_depend_on_the_number_of_threads(examined_by, jobs):
    """An expected failure does not count."""
    examined_by(lambda case, wish, run: CaseRun(_result(case)))
    cases = [make_case(str(number), *(["fail"] if number % 3 == 2 else [])) for number in range(20)]
    assert _ids(run_cases(cases, RunSettings(jobs=jobs, maxfail=2))) == ["0", "1", "2", "3", "4", "5"]
    expected = [make_case(str(number), "fail", expect="fail") for number in range(3)]
    assert len(run_cases(expected, RunSettings(jobs=jobs, maxfail=1)).results) == 3


def test_an_interrupt_keeps_what_is_finished_and_waits_for_nothing(examined_by):
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


def test_a_case_is_handed_on_where_an_interrupt_ends_the_question_how_firm_it_is(examined_by):
    def interrupt(case_id):
        raise KeyboardInterrupt

    examined_by(lambda case, wish, run: CaseRun(_result(case)))
    runs, cases = [], [make_case("first"), make_case("second")]
    campaign = run_cases(cases, RunSettings(jobs=1, firmness=interrupt), on_case=runs.append)
    assert campaign.interrupted
    assert _ids(campaign) == [run.result.id for run in runs]
    assert runs[0].result.id == "first"


def test_an_error_of_the_caller_goes_on(examined_by):
    def full(examined):
        raise OSError("No space left on device")

    examined_by(lambda case, wish, run: CaseRun(_result(case)))
    with pytest.raises(OSError, match="No space left"):
        run_cases([make_case("first"), make_case("second")], on_case=full)


def test_few_cases_are_examined_ahead_of_the_one_awaited(examined_by):
    started = []

    def examine(case, wish, run):
        started.append(case.id)
        return CaseRun(error_result(case, "made up"))

    examined_by(examine)
    run_cases([make_case(str(number)) for number in range(1000)], RunSettings(jobs=2, maxfail=1))
    assert len(started) < 20


def test_cases_are_simulated_again_with_a_recording_in_their_order(monkeypatch):
    def simulate(case, record_every):
        return SimpleNamespace(recording=f"{case.id} every {record_every} s")

    monkeypatch.setattr(uictest.rig, "simulate", simulate)
    cases = [make_case(name) for name in "abcdefgh"]
    found = [(case.id, recording) for case, recording in replay(cases, every=0.02, jobs=3)]
    assert found == [(name, f"{name} every 0.02 s") for name in "abcdefgh"]
    assert list(replay([], every=0.02, jobs=1)) == []
