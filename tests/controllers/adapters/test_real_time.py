"""Cycles paced by the clock, on a clock that the tests set."""

import pytest

from uictest.controllers import ResponseTimes
from uictest.controllers.adapters.socket import RealTime


class Clock:
    """A clock that goes only while somebody waits."""

    def __init__(self):
        self.now = 1000.0
        self.late = 0.0
        """Time that every wait takes too long, s."""

    def __call__(self):
        return self.now

    def wait(self, time):
        self.now += time + self.late


def starts_and_times(answers, clock):
    """Let each cycle of 10 ms be answered after a time, s; return when they began, s, and what was noted."""
    paced = RealTime(0.01, clock, clock.wait)
    began, starts = clock.now, []
    for time in answers:
        paced.begin_cycle()
        starts.append(clock.now - began)
        clock.now += time
        paced.end_cycle()
    return starts, paced.response_times


def test_cycles_begin_at_multiples_of_the_cycle_time_whatever_answers_take():
    starts, times = starts_and_times([0.003, 0.0, 0.009, 0.001], Clock())
    assert starts == pytest.approx([0.0, 0.01, 0.02, 0.03])
    assert times == ResponseTimes(4, 0.01, 0, pytest.approx(0.009), 2, pytest.approx(0.0, abs=1e-9))


def test_a_late_answer_misses_a_deadline_in_every_cycle_until_the_schedule_is_met():
    starts, times = starts_and_times([0.001, 0.035, 0.001, 0.001, 0.001, 0.001], Clock())
    # Cycle 1 is answered at 45 ms: cycles 2 and 3 have ended before they begin, cycle 4 ends in time.
    assert starts == pytest.approx([0.0, 0.01, 0.045, 0.046, 0.047, 0.05])
    assert (times.missed_deadlines, times.longest_answer_cycle) == (3, 1)
    assert times.longest_answer_s == pytest.approx(0.035)


def test_waits_that_take_too_long_do_not_add_up_and_are_the_jitter():
    clock = Clock()
    clock.late = 0.0005
    starts, times = starts_and_times([0.001] * 1000, clock)
    assert starts[-1] == pytest.approx(9.99 + 0.0005)
    assert times.start_jitter_s == pytest.approx(0.0005)
    assert times.missed_deadlines == 0


def test_a_late_answer_is_no_jitter_of_this_machine():
    _, times = starts_and_times([0.001, 0.035, 0.001, 0.001, 0.001, 0.001], Clock())
    assert times.start_jitter_s == pytest.approx(0.0, abs=1e-9)


def test_a_machine_that_begins_a_cycle_too_late_misses_its_deadline():
    clock = Clock()
    clock.late = 0.012
    _, times = starts_and_times([0.001, 0.001], clock)
    assert times.missed_deadlines == 1
    assert times.longest_answer_s == pytest.approx(0.001)
    assert times.start_jitter_s == pytest.approx(0.012)
