"""Results in order whatever the threads do, few calls ahead, and an end that does not wait after an error."""

import threading
import time

import pytest

from uictest.running.campaign import ThreadedMap, map_on_threads


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
