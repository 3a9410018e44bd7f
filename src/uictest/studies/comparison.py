"""The comparison with the paper in words, for the table, the lines and the files."""

from __future__ import annotations

from collections.abc import Sequence

from uictest.studies.quantity import PaperComparison, StudyQuantity
from uictest.studies.study import Study, StudyResult, Table


def ours_text(comparison: PaperComparison) -> str:
    """Return our value with its range and unit, e.g. `18.1 (17.9 .. 18.3) s`."""
    quantity, ours = comparison.quantity, comparison.ours
    text = _number(ours.value, quantity)
    if ours.low is not None and ours.high is not None:
        text += f" ({_number(ours.low, quantity)} .. {_number(ours.high, quantity)})"
    return _with_unit(text, quantity)


def band_text(quantity: StudyQuantity) -> str:
    """Return the band, e.g. `16.5 .. 19 s`, `< 2 %`, `-` where there is none."""
    if quantity.lower is not None and quantity.upper is not None:
        return _with_unit(f"{quantity.lower:g} .. {quantity.upper:g}", quantity)
    if quantity.upper is not None:
        return _with_unit(f"{'<' if quantity.below else '<='} {quantity.upper:g}", quantity)
    if quantity.lower is not None:
        return _with_unit(f">= {quantity.lower:g}", quantity)
    return "-"


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
        if band_text(quantity) != "-":
            parts.append(f"band {band_text(quantity)} ({quantity.reason})")
        shown.append(f"  {comparison.status:6}  " + "; ".join(parts))
    return shown + [f"  {note}" for note in result.findings.notes]


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
        "band_lower": [quantity.lower for quantity in quantities],
        "band_upper": [quantity.upper for quantity in quantities],
        "band_from": [quantity.reason for quantity in quantities],
        "verdict": [comparison.status for _, comparison in rows],
    }


def _number(value: float, quantity: StudyQuantity) -> str:
    return "-" if value != value else f"{value:.{quantity.digits}f}"


def _with_unit(text: str, quantity: StudyQuantity) -> str:
    return f"{text} {quantity.unit}" if quantity.unit else text
