"""The result of a sweep as text on the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from uictest import report
from uictest.report import circumstances_words, flip_words, not_judged_words

_MOST_ROWS = 30


def result_lines(result: report.SweepResult, width: int | None = None) -> Iterator[str]:
    """Yield maps, met cases per parameter, sensitivities and the frontier, a blank line between them.

    Maps keep to `width` characters, None for any width.
    """
    for sweep_map in result.maps:
        yield from report.map_lines(sweep_map, width)
        yield ""
    yield from _rates(result)
    yield from _sensitivities(result)
    if result.frontier is not None:
        yield from _frontier(result.frontier)
    yield from missed_lines(result)
    for note in result.notes:
        yield f"note: {note}"


def missed_lines(result: report.SweepResult) -> Iterator[str]:
    """Yield the first missed cases, and the number of the others."""
    for case in result.missed:
        yield f"{case.outcome}  {case.id}  {reason_missed(case.reason)}"
    if more := result.cases - result.met - len(result.missed):
        yield f"and {more} more, see summary.csv"


def reason_missed(reason: str) -> str:
    """Return why a case is not met; a case that passes has no reason of its own."""
    return reason or "another outcome was expected"


def _rates(result: report.SweepResult) -> Iterator[str]:
    for key, counts in result.rates.items():
        if len(counts) > _MOST_ROWS:
            yield f"{key}: {len(counts)} values, see rates.csv"
            continue
        yield f"{key}: cases met"
        width = max(len(count.value.label) for count in counts)
        yield from (f"  {count.value.label:>{width}}  {_share(count)}" for count in counts)
    yield ""


def _share(count: report.OutcomeCount) -> str:
    share = count.share_met
    if share is None:
        return "-"
    words = not_judged_words(count.outcomes)
    return f"{count.met} of {count.cases}  {100.0 * share:.1f} %{words}"


def _sensitivities(result: report.SweepResult) -> Iterator[str]:
    measure = ""
    width = max((len(_parameter(each)) for each in result.sensitivities), default=0)
    for each in result.sensitivities:
        if each.measure != measure:
            measure = each.measure
            yield f"sensitivity of {measure}: first order, total (95 % confidence)"
        first, total = (
            f"{index.value:6.3f} ({index.low:.3f} .. {index.high:.3f})" for index in (each.first, each.total)
        )
        yield f"  {_parameter(each):{width}}  {first}  {total}"
    if measure:
        yield ""


def _parameter(each: report.SobolSensitivity) -> str:
    return f"{each.key} at {circumstances_words(each.circumstances)}" if each.circumstances else each.key


def _most_important(scans: Sequence[report.FrontierScan]) -> Sequence[report.FrontierScan]:
    """Return the scans if they fit, else as many as fit, those with flips first."""
    if len(scans) <= _MOST_ROWS:
        return scans
    return sorted(scans, key=lambda each: not each.flips)[:_MOST_ROWS]


def _frontier(frontier: report.Frontier) -> Iterator[str]:
    yield f"frontier along {frontier.parameter}"
    for scan in _most_important(frontier.scans):
        flips = "; ".join(map(flip_words, scan.flips))
        text = "; ".join(part for part in (flips, scan.note) if part)
        yield f"  {circumstances_words(scan.circumstances)}: {text}"
    if len(frontier.scans) > _MOST_ROWS:
        yield f"  {len(frontier.scans) - _MOST_ROWS} more in frontier.csv"
    yield ""
