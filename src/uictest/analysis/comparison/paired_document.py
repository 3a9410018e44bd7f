"""Paired differences as a document."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Final

from uictest.analysis.comparison.paired_stops import (
    CONFIDENCE,
    PairedComparison,
    PairedDifference,
    PairedGroup,
)
from uictest.core.document import Column, Document, Lines, Table
from uictest.core.series_measures import Estimate
from uictest.judging import evaluation
from uictest.report import counted, number, percent_text, relative_percent
from uictest.report.page import Effect

_SHORT: Final = 24
"""Letters: sides of a longer name are called A and B, lest a table has no room for figures; chosen."""


def names_of(compared: PairedComparison) -> tuple[str, str]:
    """Return the names of the sides in tables."""
    sides = (compared.first, compared.second)
    return sides if max(map(len, sides)) <= _SHORT else ("A", "B")


def method(compared: PairedComparison) -> str:
    """Return the sentences on how paired differences are made."""
    first, second = names_of(compared)
    return (
        f"{second} - {first}, stop by stop under the same noise: mean with its interval by Student's t,"
        f" median with its interval by order statistics, {100 * CONFIDENCE:g} % each"
    )


def paired_sections(compared: PairedComparison) -> list[Table | Lines]:
    """Return a table per group that differs, and why the stops of the others do not pair."""
    groups = [group for group in compared.groups if differing(group)]
    sections: list[Table | Lines] = [Lines([f"paired: {method(compared)}"])] if groups else []
    for group in groups:
        sections += [Lines([f"paired: {group_text(group, compared)}"]), paired_table(group, compared)]
        sections.append(Lines(list(filter(None, [same_text(group)]))))
    sections.append(Lines([f"not paired: {each.name}: {each.reason}" for each in compared.not_paired]))
    return sections


def variants_document(compared: Sequence[PairedComparison]) -> Document:
    """Return every variant of a run, under the names of both sides."""
    sections: list[Table | Lines] = []
    for each in compared:
        sections.append(Lines([f"{each.second} against {each.first}"]))
        sections += paired_sections(each)
        if not each.not_paired and not any(map(differing, each.groups)):
            none = "no difference in any pair" if each.groups else "no case or series has several stops"
            sections.append(Lines([none]))
    return Document("Variants", sections)


def group_text(group: PairedGroup, compared: PairedComparison) -> str:
    """Return the sentence on which stops of a group pair."""
    pairs = f"{group.name}: {counted(group.pairs, 'pair')}, {evaluation.seeds_text(group.seeds)}"
    if group.draws < group.pairs:
        pairs += f"; only {counted(group.draws, 'draw')} of noise, so that the intervals are too narrow"
    if any(group.unpaired):
        alone = (f"{count} of {name}" for count, name in zip(group.unpaired, names_of(compared), strict=True))
        pairs += f"; without a partner: {', '.join(alone)}"
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


def _larger_count_text(each: PairedDifference) -> str:
    return f"{each.larger} of {each.pairs}" + (f" ({each.missing} without)" if each.missing else "")


def _percent_text(each: PairedDifference) -> str:
    """Return the mean difference in per cent of the median of the first side; `-` where that is 0."""
    return percent_text(relative_percent(each.first, each.first + each.mean.value, each.unit))


def _difference_columns(first: str, second: str) -> tuple[Column[PairedDifference], ...]:
    return (
        Column(heading="quantity", text=lambda each: each.quantity),
        Column(heading=first, text=lambda each: number(each.first), rank=4, right=True),
        Column(heading=second, text=lambda each: number(each.second), rank=4, right=True),
        Column(heading="mean", text=lambda each: number(each.mean.value), right=True),
        Column(heading=f"% of {first}", text=_percent_text, rank=5, right=True),
        Column(heading="interval", text=lambda each: interval_text(each.mean), right=True),
        Column(heading="median", text=lambda each: number(each.median.value), rank=2, right=True),
        Column(
            heading="interval of the median", text=lambda each: interval_text(each.median), rank=2, right=True
        ),
        Column(heading=f"{second} larger", text=_larger_count_text, rank=3, right=True),
        Column(heading="unit", text=lambda each: each.unit, rank=1),
    )


def paired_table(group: PairedGroup, compared: PairedComparison) -> Table:
    """Return the quantities of a group that differ in some pair."""
    return Table(_difference_columns(*names_of(compared)), differing(group), all_in="--format json")


def effects(group: PairedGroup) -> Iterator[Effect]:
    """Yield the mean differences in per cent of the median of the first side, where there is such a share."""
    for each in differing(group):
        ends = each.mean.value, each.mean.low, each.mean.high
        shares = [relative_percent(each.first, each.first + end, each.unit) for end in ends]
        mean, low, high = (math.nan if share is None else share for share in shares)
        if math.isfinite(mean + low + high):
            yield Effect(each.quantity, mean, low, high)
