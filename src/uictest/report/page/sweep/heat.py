"""Two swept parameters against each other, as a table whose cells are toned by what they hold."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from uictest.report.sweep.bundles import bundled, is_large
from uictest.report.sweep.wording import figure_words, share_words

MET = "met"
"""Measure of the map of verdicts."""


@dataclass(frozen=True, slots=True)
class HeatCell:
    """One cell: what it says, what it adds below, how strong its tone is (0 .. 100), where it leads."""

    text: str
    detail: str
    tone: int
    missed: bool
    key: str = ""


@dataclass(frozen=True, slots=True)
class HeatMap:
    """A map as a table. `verdicts` tells shares met from a figure; `note` says what was put together."""

    title: str
    verdicts: bool
    row_key: str
    column_key: str
    columns: Sequence[str]
    rows: Sequence[tuple[str, Sequence[HeatCell]]]
    scale: tuple[str, str]
    note: str


def heat_map(found: Mapping[str, Any], places: Mapping[tuple[str, str], str]) -> HeatMap:
    """Return a map of `sweep.json`; `places` has the key of the drawn case of a pair of values, if any."""
    shown, verdicts = bundled(found), found["measure"] == MET
    known = [mean for row in shown["means"] for mean in row if mean is not None]
    low, high = (min(known), max(known)) if known else (0.0, 0.0)
    return HeatMap(
        "Cases met" if verdicts else f"Mean {figure_words(found['measure'])}",
        verdicts,
        shown["rows"]["parameter"],
        shown["columns"]["parameter"],
        shown["columns"]["values"],
        list(_rows(shown, places, verdicts, (low, high))),
        (f"{low:.4g}", f"{high:.4g}"),
        f"Neighbouring values are put together; map-{found['measure']}.csv has each."
        if is_large(found)
        else "",
    )


def _rows(
    shown: Mapping[str, Any],
    places: Mapping[tuple[str, str], str],
    verdicts: bool,
    ends: tuple[float, float],
) -> Iterator[tuple[str, list[HeatCell]]]:
    lines = zip(shown["rows"]["values"], shown["means"], shown["met"], shown["cases"], strict=True)
    for label, means, met, cases in lines:
        keys = [places.get((label, column), "") for column in shown["columns"]["values"]]
        columns = zip(means, met, cases, keys, strict=True)
        yield label, [_share(*each[1:]) if verdicts else _mean(*each, ends) for each in columns]


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
