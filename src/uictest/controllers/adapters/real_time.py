"""Controller cycles paced by the clock, and how well both sides kept to it."""

from collections.abc import Callable
from dataclasses import dataclass
from time import monotonic, sleep


@dataclass(frozen=True, slots=True)
class ResponseTimes:
    """How a controller answered in a stop that was paced by the clock.

    Cycle ``k`` is due ``k`` cycle times after the first one began. Its inputs are sent then, or once the
    answer before has come. Its deadline is the instant at which cycle ``k + 1`` is due.

    Attributes:
        answers: number of answers.
        cycle_time_s: time from one cycle to the next.
        missed_deadlines: answers that came after their deadline.
        longest_answer_s: longest time from sending the inputs of a cycle to its answer.
        longest_answer_cycle: the cycle that took it.
        start_jitter_s: longest time from the instant at which a cycle is due to the instant at which its
            inputs are sent, without the cycles after a missed deadline: how well this machine keeps time.
    """

    answers: int
    cycle_time_s: float
    missed_deadlines: int
    longest_answer_s: float
    longest_answer_cycle: int
    start_jitter_s: float


class RealTime:
    """Paces the cycles of one stop.

    Args:
        cycle_time: from one cycle to the next, s.
        clock: the time, s.
        wait: waits for so many s.
    """

    def __init__(
        self,
        cycle_time: float,
        clock: Callable[[], float] = monotonic,
        wait: Callable[[float], None] = sleep,
    ) -> None:
        self._cycle_time = cycle_time
        self._clock = clock
        self._wait = wait
        self._first = 0.0
        self._sent = 0.0
        self._cycle = 0
        self._late = False
        self._missed = 0
        self._longest = 0.0
        self._longest_cycle = 0
        self._jitter = 0.0

    def begin_cycle(self) -> None:
        """Wait until the next cycle is due."""
        now = self._clock()
        if self._cycle == 0:
            self._first = now
        due = self._due(self._cycle)
        if now < due:
            self._wait(due - now)
            now = self._clock()
        self._sent = now
        if not self._late:
            self._jitter = max(self._jitter, now - due)

    def end_cycle(self) -> None:
        """Note that the answer has come."""
        now = self._clock()
        if now - self._sent > self._longest:
            self._longest, self._longest_cycle = now - self._sent, self._cycle
        self._cycle += 1
        self._late = now > self._due(self._cycle)
        self._missed += self._late

    @property
    def response_times(self) -> ResponseTimes:
        """How the controller answered so far."""
        return ResponseTimes(
            *(self._cycle, self._cycle_time, self._missed),
            *(self._longest, self._longest_cycle, self._jitter),
        )

    def _due(self, cycle: int) -> float:
        return self._first + cycle * self._cycle_time
