"""Many cases on the threads of this machine. The compiled rig runs without the interpreter's lock."""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field

from uictest import evaluation, scenario
from uictest.campaign.case import CaseRun, RecordingRequest, run_case
from uictest.campaign.parts import PartsOfCases, with_parts

_AHEAD = 4  # cases handed to the pool beyond the one awaited, per thread: bounds memory and wasted work


@dataclass(slots=True)
class BatchResult:
    """What a batch of cases came to: results in the order of the cases, and whether it was interrupted."""

    results: list[evaluation.CaseResult] = field(default_factory=list)
    interrupted: bool = False


def run_cases(
    cases: Sequence[scenario.Case],
    *,
    jobs: int = 1,
    recording: RecordingRequest | None = None,
    maxfail: int | None = None,
    parts: PartsOfCases | None = None,
    on_result: Callable[[CaseRun], None] = lambda examined: None,
) -> BatchResult:
    """Examine the cases on `jobs` threads, and return the results in the order of the cases.

    Each result carries the `parts` of its case.
    `on_result` is called in this thread, once per case, in the order of the cases. After `maxfail` cases that
    did not meet their expectation nothing further is reported, so that the results do not depend on `jobs`.
    A KeyboardInterrupt ends the campaign: what is finished by then is kept.
    """
    campaign = BatchResult()
    pool = ThreadPoolExecutor(max_workers=jobs, thread_name_prefix="rig")
    pending: deque[Future[CaseRun]] = deque()
    missed = 0

    def add(examined: CaseRun) -> None:
        examined = with_parts(examined, parts or {})
        campaign.results.append(examined.result)
        on_result(examined)

    try:
        for examined in _in_order(pool, cases, recording or RecordingRequest(), pending, jobs * _AHEAD):
            add(examined)
            missed += not examined.result.met
            if maxfail is not None and missed >= maxfail:
                break
    except KeyboardInterrupt:
        campaign.interrupted = True
        _keep_finished(pending, add)
    finally:
        # A stop under way cannot be broken off; after an interrupt nobody waits for it.
        pool.shutdown(wait=not campaign.interrupted, cancel_futures=True)
    return campaign


def _in_order(
    pool: ThreadPoolExecutor,
    cases: Sequence[scenario.Case],
    wish: RecordingRequest,
    pending: deque[Future[CaseRun]],
    ahead: int,
) -> Iterator[CaseRun]:
    waiting = iter(cases)
    pending.extend(pool.submit(run_case, case, wish) for case in itertools.islice(waiting, ahead))
    while pending:
        examined = pending[0].result()
        pending.popleft()
        yield examined
        pending.extend(pool.submit(run_case, case, wish) for case in itertools.islice(waiting, 1))


def _keep_finished(pending: deque[Future[CaseRun]], add: Callable[[CaseRun], None]) -> None:
    for future in pending:
        if future.done() and not future.cancelled():
            add(future.result())
