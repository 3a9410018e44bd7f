"""Apply a function to many arguments on several threads, with results in order."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import islice
from types import TracebackType
from typing import Generic, TypeVar

from uictest import rig
from uictest.core import recording
from uictest.plans import scenario
from uictest.rig import bench

Argument = TypeVar("Argument")
Result = TypeVar("Result")

_PENDING_PER_THREAD = 4
"""Calls handed to the pool per thread unless stated otherwise: bounds memory and wasted work."""


class ThreadedMap(Generic[Argument, Result]):
    """Applies `work` to each argument on `jobs` threads; iterate over it, inside `with`, for the results.

    Leaving the `with` block cancels the calls that have not started, and waits for those in progress. After
    an exception it does not wait: a call cannot be cancelled, and an interrupt should take effect at once.

    Args:
        work: the function; its exceptions are raised when its result is requested.
        arguments: one for each call, read only when the call is submitted.
        jobs: number of threads.
        pending: most calls that are submitted and whose results are not yet returned [default: 4 per thread].
    """

    def __init__(
        self,
        work: Callable[[Argument], Result],
        arguments: Iterable[Argument],
        *,
        jobs: int,
        pending: int | None = None,
    ) -> None:
        self._work = work
        self._arguments = iter(arguments)
        self._pool = ThreadPoolExecutor(max_workers=jobs, thread_name_prefix="uictest")
        self._pending: deque[Future[Result]] = deque()
        self._most_pending = pending or jobs * _PENDING_PER_THREAD

    def __enter__(self) -> ThreadedMap[Argument, Result]:
        """Submit the first calls."""
        self._submit(self._most_pending)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Cancel the calls that have not started."""
        self._pool.shutdown(wait=kind is None, cancel_futures=True)

    def __iter__(self) -> Iterator[Result]:
        """Yield the results in the order of the arguments."""
        while self._pending:
            result = self._pending[0].result()
            # The result stays pending until the next call is submitted: an interrupt does not lose it.
            self._submit(1)
            self._pending.popleft()
            yield result

    def finished(self) -> Iterator[Result]:
        """Yield the finished results that were not yet returned, in the order of the arguments."""
        for future in self._pending:
            if future.done() and not future.cancelled():
                yield future.result()

    def _submit(self, count: int) -> None:
        arguments = islice(self._arguments, count)
        self._pending.extend(self._pool.submit(self._work, argument) for argument in arguments)


def map_on_threads(
    work: Callable[[Argument], Result], arguments: Iterable[Argument], *, jobs: int
) -> Iterator[Result]:
    """Yield the result of `work` for each argument, computed on `jobs` threads, in the order given."""
    with ThreadedMap(work, arguments, jobs=jobs) as results:
        yield from results


def shortest_cycle(cases: Iterable[scenario.Case]) -> float:
    """Return the shortest controller cycle of cases, s: a recording at this interval has every command."""
    return min((float(case.scenario.controller.cycle_time) for case in cases), default=math.inf)


def replay(
    cases: Sequence[scenario.Case], *, every: float, jobs: int
) -> Iterator[tuple[scenario.Case, recording.Recording]]:
    """Yield each case with its recording, a sample `every` so many seconds, in the order of the cases."""
    stops = map_on_threads(
        lambda case: rig.simulate(bench.identified(case), record_every=every), cases, jobs=jobs
    )
    for case, stop in zip(cases, stops, strict=True):
        if stop.recording is not None:
            yield case, stop.recording
