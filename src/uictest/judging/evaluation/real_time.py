"""What stops that were paced by the clock are judged by besides their criteria."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from uictest.controllers import ResponseTimes
from uictest.judging.evaluation.verdict import Verdict

CRITERION: Final = "real-time"
"""Id of the verdict on a missed deadline."""


def missed_deadlines(times: ResponseTimes | None) -> Iterator[Verdict]:
    """Yield the verdict that a stop with missed deadlines is invalid; nothing where there are none."""
    if times is not None and times.missed_deadlines > 0:
        missed = float(times.missed_deadlines)
        yield Verdict(
            id=CRITERION,
            layer="validity",
            value=missed,
            unit="1",
            lower=None,
            upper=0.0,
            margin=-missed,
            status="fail",
            reason=_reason(times),
        )


def _reason(times: ResponseTimes) -> str:
    return (
        f"{times.missed_deadlines} of {times.answers} answers came after the end of their cycle of"
        f" {1e3 * times.cycle_time_s:g} ms; the longest took {1e3 * times.longest_answer_s:.3g} ms"
        f" (cycle {times.longest_answer_cycle})"
    )
