"""Stops that were paced by the clock: a missed deadline makes them invalid, whatever their criteria say."""

import json
from dataclasses import replace

import pytest

from uictest.controllers import ResponseTimes
from uictest.judging.evaluation import cases_document, evaluate_simulated, result_document, results_of

IN_TIME = ResponseTimes(1770, 0.01, 0, 0.0012, 700, 0.0003)
LATE = replace(IN_TIME, missed_deadlines=3, longest_answer_s=0.0314)


@pytest.fixture
def evaluate(stop, wheelsets, case, scenario, profile, criterion):
    """Judge a stop of 465 m by one requirement on its distance."""

    def judged(times, limit="500 m"):
        judged_as = case(scenario(profile(criterion(layer="requirement", upper=limit))))
        return evaluate_simulated(judged_as, stop(), wheelsets(), response_times=times)

    return judged


def test_a_stop_without_a_missed_deadline_is_judged_as_any_other(evaluate):
    with_clock, without = cases_document([replace(evaluate(IN_TIME), response_times=None), evaluate(None)])
    assert with_clock == without
    assert with_clock["outcome"] == "pass"


def test_a_missed_deadline_makes_a_stop_invalid_before_a_failed_requirement_and_says_how_late(evaluate):
    result = evaluate(LATE)
    assert result.outcome == "invalid"
    assert result.reason == (
        "real-time: 3 of 1770 answers came after the end of their cycle of 10 ms; the longest took 31.4 ms"
        " (cycle 700)"
    )
    assert (result.criteria[-1].value, result.criteria[-1].upper) == (3.0, 0.0)
    assert evaluate(None, "400 m").outcome == "fail"
    assert evaluate(LATE, "400 m").outcome == "invalid"


def test_the_document_has_response_times_in_real_time_only_and_they_are_read_back(evaluate):
    with_clock, without = cases_document([evaluate(LATE), evaluate(None)])
    assert with_clock["response_times"] == {
        "answers": 1770,
        "cycle_time_s": 0.01,
        "missed_deadlines": 3,
        "longest_answer_s": 0.0314,
        "longest_answer_cycle": 700,
        "start_jitter_s": 0.0003,
    }
    assert set(with_clock) - set(without) == {"response_times"}
    result = evaluate(LATE)
    document = json.loads(json.dumps(result_document([result])))
    assert results_of(document)[0].response_times == LATE
