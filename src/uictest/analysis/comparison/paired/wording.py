"""Paired differences in words: lines for the terminal, cells for the page."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Final

from uictest.analysis.comparison.paired.difference import CONFIDENCE, PairedDifference, PairedGroup
from uictest.analysis.comparison.paired.pairing import PairedComparison
from uictest.core.series_measures import Estimate
from uictest.judging import evaluation
from uictest.report import (
    TableColumn,
    aligned,
    columns_not_shown,
    counted,
    fitted,
    number,
    percent_text,
    printable,
    relative_percent,
)

METHOD: Final = (
    "second - first, stop by stop under the same noise: mean with its interval by Student's t, median with"
    f" its interval by order statistics, {100 * CONFIDENCE:g} % each"
)
"""How all paired differences are made."""

HEADINGS: Final = (
    *("quantity", "first", "second", "mean", "interval", "median", "interval of the median"),
    *("second larger", "unit"),
)
_RANKS: Final = (0, 4, 4, 0, 0, 2, 2, 3, 1)


def paired_lines(compared: PairedComparison, width: int | None = None) -> Iterator[str]:
    """Yield a table per group that differs, and why the stops of the others do not pair.

    The tables are at most `width` characters wide, None for any width.
    """
    groups = [group for group in compared.groups if differing(group)]
    if groups:
        yield f"paired: {METHOD}"
    for group in groups:
        yield f"paired: {printable(group_text(group))}"
        yield from _table(group, width)
        if same := same_text(group):
            yield same
    for each in compared.not_paired:
        yield f"not paired: {printable(f'{each.name}: {each.reason}')}"


def variants_lines(compared: Sequence[PairedComparison], width: int | None = None) -> Iterator[str]:
    """Yield the lines of every variant of a run, under the names of both sides."""
    for each in compared:
        yield printable(f"first {each.first}, second {each.second}")
        lines = list(paired_lines(each, width))
        yield from lines
        if not lines:
            yield "no difference in any pair" if each.groups else "no case or series has several stops"


def group_text(group: PairedGroup) -> str:
    """Return which stops of a group pair."""
    pairs = f"{group.name}: {counted(group.pairs, 'pair')}, {evaluation.seeds_text(group.seeds)}"
    if group.draws < group.pairs:
        pairs += f"; only {counted(group.draws, 'draw')} of noise, so that the intervals are too narrow"
    first, second = group.unpaired
    if first or second:
        pairs += f"; without a partner: {first} of the first, {second} of the second"
    return pairs


def same_text(group: PairedGroup) -> str:
    """Return the quantities that are the same in every pair; empty where there is none."""
    same = [each.quantity for each in group.differences if each.is_zero]
    return f"the same in every pair: {', '.join(same)}" if same else ""


def differing(group: PairedGroup) -> list[PairedDifference]:
    """Return the quantities that differ in some pair."""
    return [each for each in group.differences if not each.is_zero]


def interval_text(estimate: Estimate) -> str:
    """Return the ends of an interval; `-` where there is none."""
    ends = estimate.low, estimate.high
    return "-" if any(map(math.isnan, ends)) else " .. ".join(map(number, ends))


def paired_cells(each: PairedDifference) -> tuple[str, ...]:
    """Return the cells of a quantity under `HEADINGS`."""
    numbers = number(each.first), number(each.second), number(each.mean.value), interval_text(each.mean)
    larger = f"{each.larger} of {each.pairs}" + (f" ({each.missing} without)" if each.missing else "")
    medians = number(each.median.value), interval_text(each.median)
    return (each.quantity, *numbers, *medians, larger, each.unit)


def paired_percent(each: PairedDifference) -> str:
    """Return the mean difference in per cent of the median of the first side; `-` where that is 0."""
    return percent_text(relative_percent(each.first, each.first + each.mean.value, each.unit))


def _table(group: PairedGroup, width: int | None) -> Iterator[str]:
    cells = zip(*map(paired_cells, differing(group)), strict=True)
    columns = [
        TableColumn(heading, list(map(printable, texts)), rank)
        for heading, texts, rank in zip(HEADINGS, cells, _RANKS, strict=True)
    ]
    shown, hidden = fitted(columns, width)
    yield from aligned(shown)
    if line := columns_not_shown(hidden, "--format json has them"):
        yield line
