"""The parts of a sweep on the threads of this machine."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import islice
from typing import Final

OnPart = Callable[[int, bytes], None]
Work = Callable[[int], bytes]
_AHEAD: Final = 2
"""Parts that wait or are ready beyond those in work: bounds memory."""


def run_parts(numbers: Iterable[int], work: Work, jobs: int, on_part: OnPart) -> None:
    """Work out parts on `jobs` threads; `on_part` gets each in this thread, in the order of the numbers.

    Whatever leaves this function, a KeyboardInterrupt too, leaves the parts that `on_part` has had.
    """
    pool = ThreadPoolExecutor(max_workers=jobs, thread_name_prefix="sweep")
    waiting = iter(numbers)
    pending: deque[tuple[int, Future[bytes]]] = deque()
    ended = False
    try:
        pending.extend((number, pool.submit(work, number)) for number in islice(waiting, jobs + _AHEAD))
        while pending:
            number, future = pending[0]
            content = future.result()
            pending.popleft()
            pending.extend((other, pool.submit(work, other)) for other in islice(waiting, 1))
            on_part(number, content)
        ended = True
    finally:
        # A part in work cannot be broken off; after an interrupt or a full disk nobody waits for it.
        pool.shutdown(wait=ended, cancel_futures=True)
