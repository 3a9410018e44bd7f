"""What the verdicts of a stop amount to."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from uictest.evaluation.result import Outcome
from uictest.evaluation.verdict import Layer, Status, Verdict


def outcome_of(verdicts: Iterable[Verdict]) -> tuple[Outcome, str]:
    """Return the outcome of a stop and why.

    A failed validity criterion makes the stop invalid: it does not count as a test, so its requirements say
    nothing. Otherwise a failed requirement fails it, unless a validity criterion could not be judged: the
    stop may be no test. Whatever else could not be judged makes it inconclusive; without any applicable
    criterion it is skipped.
    """
    verdicts = list(verdicts)
    if broken := _reasons(verdicts, ("fail",), "validity"):
        return "invalid", broken
    broken = _reasons(verdicts, ("fail",), "requirement")
    if broken and not _reasons(verdicts, ("inconclusive",), "validity"):
        return "fail", broken
    if any(verdict.status == "inconclusive" for verdict in verdicts):
        return "inconclusive", _reasons(verdicts, ("fail", "inconclusive"))
    if not any(verdict.status == "pass" for verdict in verdicts):
        return "skipped", _reasons(verdicts, ("not_applicable",)) or "no criterion"
    return "pass", ""


def _reasons(verdicts: list[Verdict], statuses: Sequence[Status], layer: Layer | None = None) -> str:
    return "; ".join(
        f"{verdict.id}: {verdict.reason}"
        for verdict in verdicts
        if verdict.status in statuses and layer in (None, verdict.layer)
    )
