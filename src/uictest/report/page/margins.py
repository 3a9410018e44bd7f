"""The criteria of a stop on one scale: the margin of each over its limit."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Final, NamedTuple

from uictest.judging import evaluation
from uictest.report.case_lines import NARROW
from uictest.report.traces.instants import Taken, taken_at
from uictest.report.traces.quantities import WHEELSETS
from uictest.report.traces.trace import PlotTrace
from uictest.report.verdict_sentences import (
    MOST_URGENT,
    check_sentence,
    missed_by_text,
    value_with_limit,
    without_checks_that_hold,
)

_WORDS: Final = {"pass": "met", "fail": "missed"}
"""Status of a criterion that was judged -> what stands for a margin that is not a share."""
_MOST_CRITERIA: Final = 10
"""Columns of the matrix: more would leave no room for the names of the cases."""


class Margin(NamedTuple):
    """The margin of one criterion: `share` of its value in per cent of the limit, negative if missed.

    `share` is None for a criterion that was not judged, that only says yes or no, or whose limit is 0.
    `taken` is where the plots show its value, `baseline` the value that was accepted; None where there is
    none.
    """

    verdict: evaluation.Verdict
    share: float | None
    taken: Taken | None
    baseline: float | None = None

    @property
    def to_spare(self) -> float | None:
        """The share as cases are ranked by it: a verdict that turns has none to spare, at most 0."""
        return self.share if self.share is None or self.verdict.steady else min(self.share, 0.0)

    @property
    def judged(self) -> bool:
        """Whether the criterion came to a verdict."""
        return self.verdict.status in _WORDS

    @property
    def kind(self) -> str:
        """What a cell of the matrix is coloured and shaped by."""
        if not self.judged:
            return "not-judged" if self.verdict.status == "not_applicable" else "inconclusive"
        if self.verdict.status == "fail":
            return "fail"
        if not self.verdict.steady:
            return "turns"
        return "pass" if self.share is None or self.share >= NARROW else "narrow"

    @property
    def bar(self) -> tuple[float, float]:
        """Beginning and width of the bar, in per cent of the scale; the limit is in its middle."""
        share = min(max(self.share or 0.0, -100.0), 100.0)
        return 50.0 + min(share, 0.0) / 2, abs(share) / 2

    @property
    def share_text(self) -> str:
        """The share to spare with its sign and unit; `turns` where a verdict that passes has none.

        More than twice an upper limit is a multiple of it.
        """
        share = self.to_spare
        if share is None or not self.judged:
            return _WORDS.get(self.verdict.status, "")
        if self.verdict.status == "pass" and not self.verdict.steady:
            return "turns"
        if share == 0.0:
            return "0 %"
        if share < -100.0 and self.verdict.lower is None:
            return f"{1.0 - share / 100.0:.3g} × limit"  # noqa: RUF001 - a sign on paper
        return f"{share:+.3g} %" if abs(share) < 1e3 else f"{share:+.0f} %"

    @property
    def value_text(self) -> str:
        """The value next to its limits, and which wheelsets miss them; the reason where there is no value."""
        verdict = self.verdict
        if verdict.value is None and verdict.reason:
            return verdict.reason
        missed_by = missed_by_text(verdict, len(WHEELSETS)) if verdict.status == "fail" else ""
        return ", ".join(filter(None, (value_with_limit(verdict), missed_by)))


class Margins(NamedTuple):
    """Criteria, those missed first, then inconclusive ones, then the narrowest margin; the rig's checks."""

    judged: Sequence[Margin]
    not_applicable: Sequence[Margin]
    rig: str


def margins_of(
    verdicts: Sequence[evaluation.Verdict],
    drawn: Iterable[evaluation.Verdict] = (),
    trace: PlotTrace | None = None,
    accepted: Mapping[str, float] = MappingProxyType({}),
) -> Margins:
    """Return the margins of a case.

    Args:
        verdicts: verdicts of the case.
        drawn: of the stop that is drawn: of a repeated case this is one of several.
        trace: trace of the stop that is drawn; None where none is.
        accepted: criterion -> its value in the baseline.

    """
    of_stop = {verdict.id: verdict for verdict in drawn}
    margins = []
    for verdict in without_checks_that_hold(verdicts):
        share, taken = None, None
        if verdict.status in _WORDS:
            share = margin_share(verdict)
            taken = taken_at(of_stop.get(verdict.id, verdict), trace) if trace else None
        margins.append(Margin(verdict, share, taken, accepted.get(verdict.id)))
    margins.sort(key=_urgency)
    applicable = [margin for margin in margins if margin.verdict.status != "not_applicable"]
    return Margins(applicable, margins[len(applicable) :], check_sentence(verdicts))


def _urgency(margin: Margin) -> tuple[int, bool, float]:
    return MOST_URGENT.index(margin.verdict.status), margin.share is None, margin.to_spare or 0.0


def margin_share(verdict: evaluation.Verdict) -> float | None:
    """Return the margin in per cent of the limit, of two the larger one; None where there is no such share.

    A criterion that is met exactly, as that of standstill is, only says yes or no.
    """
    bound = max(abs(verdict.lower or 0.0), abs(verdict.upper or 0.0))
    says_yes = verdict.margin == 0.0 and verdict.status == "pass" and verdict.steady
    if verdict.margin is None or not bound or says_yes:
        return None
    return 100.0 * verdict.margin / bound


class Matrix(NamedTuple):
    """Cases against criteria: the names of the columns, the cells of a case by its id, what has no room."""

    criteria: Sequence[str]
    cells: Mapping[str, Sequence[Margin | None]]
    left_out: int


def matrix_of(margins: Mapping[str, Margins]) -> Matrix:
    """Return the matrix of a run; of more criteria than have room those that some case misses stay first.

    A criterion that only says yes, and does so in every case, has no column.
    """
    rows = {
        case_id: {margin.verdict.id: margin for margin in (*of_case.judged, *of_case.not_applicable)}
        for case_id, of_case in margins.items()
    }
    every = [margin for row in rows.values() for margin in row.values()]
    all_criteria = dict.fromkeys(
        margin.verdict.id for margin in every if margin.share is not None or margin.kind != "pass"
    )
    missed = {margin.verdict.id for margin in every if margin.kind == "fail"}
    criteria = sorted(sorted(all_criteria, key=lambda criterion: criterion not in missed)[:_MOST_CRITERIA])
    cells = {case_id: [row.get(criterion) for criterion in criteria] for case_id, row in rows.items()}
    return Matrix(criteria, cells, len(all_criteria) - len(criteria))
