"""Show the cases and the result of a sweep on stdout."""

from __future__ import annotations

import sys
from collections.abc import Iterator

from uictest import report, runs
from uictest.cli.options import Format
from uictest.cli.output import data, terminal_width
from uictest.report import printable
from uictest.running import chunked

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
    for line in report.sweep_annotations(content.result, str(content.manifest.get("file", ""))):
        data(line)


def result_lines(result: report.SweepResult, width: int | None = None) -> Iterator[str]:
    """Yield maps, met cases by parameter, sensitivities, tails and the frontier, a blank line between them.

    Maps and tables keep to `width` characters, None for any width.
    """
    for sweep_map in result.maps:
        yield from report.map_lines(sweep_map, width)
        yield ""
    yield from report.titled_lines(report.numbers_of_sweep(result), width)
    yield from missed_lines(result)
    for note in result.notes:
        yield f"note: {note}"


def missed_lines(result: report.SweepResult) -> Iterator[str]:
    """Yield the first missed cases, and the number of the others."""
    for case in result.missed:
        yield f"{case.outcome}  {case.id}  {runs.reason_missed(case.reason)}"
    if more := result.cases - result.met - len(result.missed):
        yield f"and {more} more, see {report.every_case(result.cases)}"
