"""Two swept parameters against each other, as a table with cells coloured by their value."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from uictest.report.sweep.folding import FoldedMap, folded, is_large, short_label
from uictest.report.sweep.result import SweepMap
from uictest.report.sweep.wording import measure_words, share_words


@dataclass(frozen=True, slots=True)
class HeatCell:
    """One cell: its text, details below, the strength of its colour (0 .. 100), the stop that it links to."""

    text: str
    detail: str
    tone: int
    missed: bool
    key: str = ""


@dataclass(frozen=True, slots=True)
class HeatMap:
    """A map as a table. `verdicts`: it shows shares of cases met; `note` says which values are together."""

    title: str
    verdicts: bool
    row_key: str
    column_key: str
    columns: Sequence[str]
    rows: Sequence[tuple[str, Sequence[HeatCell]]]
    scale: tuple[str, str]
    note: str


def heat_map(sweep_map: SweepMap, keys: Mapping[tuple[str, str], str]) -> HeatMap:
    """Return a map as a table; `keys` has the key of the drawn case for a pair of values, if any."""
    shown, measure, verdicts = folded(sweep_map), sweep_map.measure, sweep_map.shows_met
    known = [mean for row in shown.means for mean in row if mean is not None]
    low, high = (min(known), max(known)) if known else (0.0, 0.0)
    note = f"Neighbouring values are put together; map-{measure}.csv has each."
    return HeatMap(
        "Cases met" if verdicts else f"Mean {measure_words(measure)}",
        verdicts,
        sweep_map.rows.parameter,
        sweep_map.columns.parameter,
        list(map(short_label, shown.columns)),
        list(_rows(shown, keys, verdicts, (low, high))),
        (f"{low:.4g}", f"{high:.4g}"),
        note if is_large(sweep_map) else "",
    )


def _rows(
    shown: FoldedMap,
    keys: Mapping[tuple[str, str], str],
    verdicts: bool,
    ends: tuple[float, float],
) -> Iterator[tuple[str, list[HeatCell]]]:
    column_labels = list(map(short_label, shown.columns))
    for values, means, met, cases in zip(shown.rows, shown.means, shown.met, shown.cases, strict=True):
        label = short_label(values)
        case_keys = [keys.get((label, column), "") for column in column_labels]
        cells = zip(means, met, cases, case_keys, strict=True)
        yield label, [_share(*cell[1:]) if verdicts else _mean(*cell, ends) for cell in cells]


def _share(met: int, cases: int, key: str) -> HeatCell:
    words = share_words(met, cases)
    detail = f"{met} of {cases}" if cases > 1 else ""
    tone = round(100 * met / cases) if cases else 0
    return HeatCell(f"{words} %" if cases else words, detail, tone, met < cases, key)


def _mean(mean: float | None, met: int, cases: int, key: str, ends: tuple[float, float]) -> HeatCell:
    low, high = ends
    if mean is None:
        return HeatCell("–", "", 0, met < cases, key)  # noqa: RUF001 - a dash on paper
    tone = round(100 * (mean - low) / (high - low)) if high > low else 0
    return HeatCell(f"{mean:.4g}", "", tone, met < cases, key)
