"""What a sweep shows a reader at its end."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict

from uictest import sweep
from uictest.report import circumstances_words, flip_words, not_judged_words

_MOST_ROWS = 30


def finding_lines(findings: sweep.SweepFindings, width: int | None = None) -> Iterator[str]:
    """Yield maps, met cases per parameter, sensitivities and the frontier, a blank line between them.

    Maps keep to `width` characters, None for any width.
    """
    for found in findings.maps:
        yield from sweep.map_lines(found, width)
        yield ""
    yield from _rates(findings.tally)
    yield from _sensitivities(findings)
    yield from _frontier(findings)
    yield from missed_lines(findings)
    for note in findings.notes:
        yield f"note: {note}"


def missed_lines(findings: sweep.SweepFindings) -> Iterator[str]:
    """Yield the first cases that are not met, and how many there are beyond them."""
    tally, total = findings.tally, findings.tally.total()
    for name, outcome, reason in tally.missed:
        yield f"{outcome}  {name}  {reason_missed(reason)}"
    if more := total.cases - total.met - len(tally.missed):
        yield f"and {more} more, see summary.csv"


def reason_missed(reason: str) -> str:
    """Return why a case is not met; one that passes has no reason of its own."""
    return reason or "another outcome was expected"


def _rates(tally: sweep.Tally) -> Iterator[str]:
    for key in tally.classes:
        counts = tally.by_class(key)
        if len(counts) > _MOST_ROWS:
            yield f"{key}: {len(counts)} values, see rates.csv"
            continue
        yield f"{key}: cases met"
        width = max(len(count.label) for count in counts)
        yield from (f"  {count.label:>{width}}  {_share(count)}" for count in counts)
    yield ""


def _share(count: sweep.OutcomeCount) -> str:
    if not count.cases:
        return "-"
    words = not_judged_words(count.outcomes)
    return f"{count.met} of {count.cases}  {100.0 * count.share_met:.1f} %{words}"


def _sensitivities(findings: sweep.SweepFindings) -> Iterator[str]:
    measure = ""
    width = max((len(_parameter(each)) for each in findings.sensitivities), default=0)
    for each in findings.sensitivities:
        if each.measure != measure:
            measure = each.measure
            yield f"sensitivity of {measure}: first order, total (95 % confidence)"
        first, total = (
            f"{index.value:6.3f} ({index.low:.3f} .. {index.high:.3f})" for index in (each.first, each.total)
        )
        yield f"  {_parameter(each):{width}}  {first}  {total}"
    if measure:
        yield ""


def _parameter(each: sweep.Sensitivity) -> str:
    where = ", ".join(f"{key} = {text}" for key, text in each.circumstances.items())
    return f"{each.key} at {where}" if where else each.key


def _shown(frontier: Sequence[sweep.FrontierScan]) -> Sequence[sweep.FrontierScan]:
    """Return as many as fit, in their order; where that is not all, those that flip come first."""
    if len(frontier) <= _MOST_ROWS:
        return frontier
    return sorted(frontier, key=lambda each: not each.flips)[:_MOST_ROWS]


def _frontier(findings: sweep.SweepFindings) -> Iterator[str]:
    if not findings.frontier_key:
        return
    yield f"frontier along {findings.frontier_key}"
    for stretch in _shown(findings.frontier):
        flips = "; ".join(flip_words(asdict(flip)) for flip in stretch.flips)
        found = "; ".join(text for text in (flips, stretch.note) if text)
        yield f"  {circumstances_words(stretch.circumstances)}: {found}"
    if len(findings.frontier) > _MOST_ROWS:
        yield f"  {len(findings.frontier) - _MOST_ROWS} more in frontier.csv"
    yield ""
