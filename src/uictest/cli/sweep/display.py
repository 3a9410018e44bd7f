"""Show the cases and the result of a sweep on stdout."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence

from uictest import report, runs
from uictest.cli.options import Format
from uictest.cli.output import data, terminal_width
from uictest.report import printable
from uictest.running import chunked

_MOST_ROWS = 30
_IDS_AT_ONCE = 4096


def show_ids(selection: chunked.CaseSelection) -> bool:
    """Write the ids of the selected cases to stdout, one per line; return whether all were accepted."""
    for first in range(0, selection.size, _IDS_AT_ONCE):
        indices = selection.indices(first, min(first + _IDS_AT_ONCE, selection.size))
        if not data("\n".join(map(printable, selection.plan.ids(indices)))):
            return False
    return True


def show_result(result: report.SweepResult, document: str, shown: Format, *, quiet: bool) -> None:
    """Write the result document, or maps, rates and the frontier as text, to stdout.

    If `quiet`, write only the cases that missed their expectation; annotations list these already.
    """
    if shown is Format.JSON:
        data(document.rstrip("\n"))
        return
    if quiet and shown is Format.GITHUB:
        return
    width = terminal_width(sys.stdout)
    for line in missed_lines(result) if quiet else result_lines(result, width):
        text = printable(line) if line else line
        if shown is Format.GITHUB:
            data(report.no_command(text))
        else:
            data(text if width is None else "\n".join(report.wrapped_name(text, width)))


def show_annotations(content: report.SweepContent) -> None:
    """Write the worst missed cases and the counts of the sweep as annotations to stdout."""
    for line in report.sweep_annotations(content):
        data(line)


def result_lines(result: report.SweepResult, width: int | None = None) -> Iterator[str]:
    """Yield maps, met cases by parameter, sensitivities, tails and the frontier, a blank line between them.

    Maps keep to `width` characters, None for any width.
    """
    for sweep_map in result.maps:
        yield from report.map_lines(sweep_map, width)
        yield ""
    yield from _rates(result)
    yield from _sensitivities(result)
    yield from report.tail_lines(result)
    if result.frontier is not None:
        yield from _frontier(result.frontier)
    yield from missed_lines(result)
    for note in result.notes:
        yield f"note: {note}"


def missed_lines(result: report.SweepResult) -> Iterator[str]:
    """Yield the first missed cases, and the number of the others."""
    for case in result.missed:
        yield f"{case.outcome}  {case.id}  {runs.reason_missed(case.reason)}"
    if more := result.cases - result.met - len(result.missed):
        yield f"and {more} more, see {report.every_case(result.cases)}"


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
    words = report.not_judged_words(count.outcomes)
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
    return (
        f"{each.key} at {report.circumstances_words(each.circumstances)}" if each.circumstances else each.key
    )


def _most_important(scans: Sequence[report.FrontierScan]) -> Sequence[report.FrontierScan]:
    """Return the scans if they are few, else the first ones, those with flips before the others."""
    if len(scans) <= _MOST_ROWS:
        return scans
    return sorted(scans, key=lambda each: not each.flips)[:_MOST_ROWS]


def _frontier(frontier: report.Frontier) -> Iterator[str]:
    yield f"frontier along {frontier.parameter}"
    for scan in _most_important(frontier.scans):
        flips = "; ".join(map(report.flip_words, scan.flips))
        text = "; ".join(part for part in (flips, scan.note) if part)
        yield f"  {report.circumstances_words(scan.circumstances)}: {text}"
    if len(frontier.scans) > _MOST_ROWS:
        yield f"  {len(frontier.scans) - _MOST_ROWS} more in frontier.csv"
    yield ""
