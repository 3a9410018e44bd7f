"""The comparison with the paper in words, and the table of claims, for terminal, page and files."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from studies.quantity import RESULTS, STATUSES, PaperComparison, SourceBand, StudyQuantity
from studies.study import Study, StudyResult, Table
from uictest.report import aligned_rows, counted

if TYPE_CHECKING:
    from rich.console import Group


def ours_text(comparison: PaperComparison) -> str:
    """Return our value with its range and unit, e.g. `18.1 (17.9 .. 18.3) s`."""
    quantity, ours = comparison.quantity, comparison.ours
    text = _number(ours.value, quantity)
    if ours.low is not None and ours.high is not None:
        text += f" ({_number(ours.low, quantity)} .. {_number(ours.high, quantity)})"
    return _with_unit(text, quantity)


def band_text(quantity: StudyQuantity) -> str:
    """Return the band, e.g. `16.5 .. 19 s`, `< 2 %`, `-` where there is none."""
    band = quantity.band
    if band is None:
        return "-"
    if band.lower is None:
        return _with_unit(f"{'<' if band.below else '<='} {band.upper:g}", quantity)
    upper = "" if band.upper is None else f"{band.upper:g}"
    least = f"{'>' if band.above else '>='} {band.lower:g}"
    return _with_unit(f"{band.lower:g} .. {upper}" if upper else least, quantity)


def band_origin(quantity: StudyQuantity) -> str:
    """Return whose band it is: `source`, `ours`, or empty where there is none."""
    if quantity.band is None:
        return ""
    return "source" if isinstance(quantity.band, SourceBand) else "ours"


def result_text(comparison: PaperComparison) -> str:
    """Return the result of a quantity, with what was declared."""
    if comparison.is_declared_miss:
        return "misses, declared"
    return f"{comparison.result}, declared missed" if comparison.quantity.declared_miss else comparison.result


def declared_misses(result: StudyResult) -> list[str]:
    """Return why the bands that are declared missed are missed, one sentence for each reason."""
    by_reason: dict[str, list[str]] = {}
    for quantity in result.study.quantities:
        if quantity.declared_miss:
            by_reason.setdefault(quantity.declared_miss, []).append(quantity.title)
    return [f"Declared missed: {'; '.join(titles)}. {reason}" for reason, titles in by_reason.items()]


def tally(results: Sequence[StudyResult]) -> str:
    """Return how many values hold, miss and are shown: `3 values: 1 hold, 1 miss (1 declared), 1 shown`."""
    rows = [comparison for each in results for comparison in each.comparisons]
    held, missed, shown = (sum(each.result == result for each in rows) for result in RESULTS)
    declared = f" ({sum(each.is_declared_miss for each in rows)} declared)" if missed else ""
    return f"{counted(len(rows), 'value')}: {held} hold, {missed} miss{declared}, {shown} shown"


def misses(results: Sequence[StudyResult]) -> list[str]:
    """Return the values that miss or are not as declared, as lines of a table."""
    rows = [
        (each.study.name, comparison)
        for each in results
        for comparison in each.comparisons
        if comparison.result == "misses" or comparison.fails
    ]
    table = [
        (
            name,
            comparison.quantity.title,
            band_text(comparison.quantity),
            ours_text(comparison),
            comparison.quantity.status,
            result_text(comparison),
        )
        for name, comparison in rows
    ]
    titles = ("study", "quantity", "band", "ours", "status", "result")
    return list(aligned_rows([titles, *table])) if rows else []


def claim_counts(results: Sequence[StudyResult]) -> list[list[str]]:
    """Return how many values hold, miss and are shown, by their status: rows of a table, titles first."""
    rows = [comparison for each in results for comparison in each.comparisons]
    counts = Counter((comparison.quantity.status, comparison.result) for comparison in rows)
    table = [[counts[status, result] for result in RESULTS] for status in STATUSES]
    together = [sum(column) for column in zip(*table, strict=True)]
    named = zip((*STATUSES, "all"), (*table, together), strict=True)
    return [["status", *RESULTS], *([name, *map(str, row)] for name, row in named)]


def claims(results: Sequence[StudyResult]) -> list[str]:
    """Return the table of :func:`claim_counts` as lines."""
    return list(aligned_rows(claim_counts(results)))


def paper_text(study: Study) -> str:
    """Return a sentence with the text of the paper."""
    if not study.paper:
        return "Our own study: the paper has no values to compare with."
    return f"The data of the paper's figures and tables are not public; its text says: {study.paper}."


def lines(result: StudyResult) -> list[str]:
    """Return a study as lines of text: its name and title, a line for every quantity, the notes."""
    study = result.study
    shown = [f"{study.name}: {study.title}", f"  {paper_text(study)}"]
    for comparison in result.comparisons:
        quantity = comparison.quantity
        parts = [f"{quantity.title}: paper {quantity.paper}", f"ours {ours_text(comparison)}"]
        if quantity.band is not None:
            parts.append(f"band {band_text(quantity)} ({quantity.band.reason})")
        shown.append(f"  {result_text(comparison)}  {quantity.status}  " + "; ".join(parts))
    return shown + [f"  {note}" for note in (*declared_misses(result), *result.findings.notes)]


def comparison_table(results: Sequence[StudyResult]) -> Table:
    """Return every comparison of every study as columns of `comparison.csv`."""
    rows = [(each.study, comparison) for each in results for comparison in each.comparisons]
    quantities = [comparison.quantity for _, comparison in rows]
    return {
        "study": [study.name for study, _ in rows],
        "quantity": [quantity.key for quantity in quantities],
        "title": [quantity.title for quantity in quantities],
        "unit": [quantity.unit for quantity in quantities],
        "source": [quantity.paper for quantity in quantities],
        "here": [comparison.ours.value for _, comparison in rows],
        "here_low": [comparison.ours.low for _, comparison in rows],
        "here_high": [comparison.ours.high for _, comparison in rows],
        "status": [quantity.status for quantity in quantities],
        "result": [comparison.result for _, comparison in rows],
        "band": [band_origin(quantity) for quantity in quantities],
        "band_lower": [quantity.band and quantity.band.lower for quantity in quantities],
        "band_upper": [quantity.band and quantity.band.upper for quantity in quantities],
        "band_from": [quantity.band and quantity.band.reason for quantity in quantities],
        "declared_miss": [quantity.declared_miss for quantity in quantities],
    }


def _number(value: float, quantity: StudyQuantity) -> str:
    return "-" if value != value else f"{value:.{quantity.digits}f}"


def _with_unit(text: str, quantity: StudyQuantity) -> str:
    return f"{text} {quantity.unit}" if quantity.unit else text


_STYLES = {"holds": "green", "misses": "yellow", "shown": "dim"}


def study_table(result: StudyResult) -> Group:
    """Return title, what the paper says, a row for every quantity, and the notes."""
    from rich.console import Group
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    study = result.study
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("quantity", overflow="fold", ratio=5)
    table.add_column("paper", overflow="fold", ratio=3)
    table.add_column("ours", overflow="fold", ratio=4)
    table.add_column("band", overflow="fold", ratio=3)
    table.add_column("status", no_wrap=True)
    table.add_column("result", no_wrap=True)
    for comparison in result.comparisons:
        quantity = comparison.quantity
        cells = (quantity.title, quantity.paper, ours_text(comparison), band_text(quantity), quantity.status)
        style = "bold red" if comparison.fails else _STYLES[comparison.result]
        table.add_row(*map(Text, cells), Text(result_text(comparison), style=style))
    heading = Text(f"{study.name}  ", style="bold").append(study.title, style="not bold")
    paper = Text(paper_text(study), style="dim")
    notes = [Text(note, style="dim") for note in (*declared_misses(result), *result.findings.notes)]
    return Group(heading, paper, Padding(table, (1, 0, 1, 2)), *notes, Text())


SCHEMA = "uictest/studies/2"


def document(results: Sequence[StudyResult]) -> str:
    """Return the document as JSON; a value that is not finite is null."""
    studies = [
        {
            "name": each.study.name,
            "title": each.study.title,
            "source": each.study.paper,
            "result": each.result,
            "fails": each.fails,
            "quantities": [_quantity(comparison) for comparison in each.comparisons],
            "notes": list(each.findings.notes),
        }
        for each in results
    ]
    return json.dumps({"schema": SCHEMA, "studies": studies}, indent=2)


def _quantity(comparison: PaperComparison) -> dict[str, Any]:
    quantity, ours, band = comparison.quantity, comparison.ours, comparison.quantity.band
    return {
        "key": quantity.key,
        "title": quantity.title,
        "unit": quantity.unit,
        "source": quantity.paper,
        "value": _finite(ours.value),
        "low": _finite(ours.low),
        "high": _finite(ours.high),
        "status": quantity.status,
        "result": comparison.result,
        "band": band
        and {
            "of": band_origin(quantity),
            "lower": band.lower,
            "upper": band.upper,
            "lower_excluded": band.above,
            "upper_excluded": band.below,
            "reason": band.reason,
        },
        "declared_miss": quantity.declared_miss,
        "fails": comparison.fails,
    }


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None
