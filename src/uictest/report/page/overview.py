"""What a page shows of all cases: maps of two swept keys, and the parts in full."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

from uictest.judging import evaluation


class CaseMap(NamedTuple):
    """Cases of a scenario by two keys; `cells[row][column]` is None where there is no such case."""

    scenario: str
    row_key: str
    column_key: str
    rows: Sequence[str]
    columns: Sequence[str]
    cells: Sequence[Sequence[evaluation.CaseResult | None]]


def maps_of(results: Iterable[evaluation.CaseResult]) -> list[CaseMap]:
    """Return a map for every scenario whose cases vary in exactly two keys, two values of each or more."""
    by_sweep: dict[tuple[str, ...], list[evaluation.CaseResult]] = {}
    for result in results:
        by_sweep.setdefault((result.scenario, *result.parameters), []).append(result)
    maps = (_map(scenario, keys, cases) for (scenario, *keys), cases in by_sweep.items())
    return [case_map for case_map in maps if case_map is not None]


def _map(scenario: str, keys: Sequence[str], cases: Sequence[evaluation.CaseResult]) -> CaseMap | None:
    moving = [key for key in keys if len({case.parameters[key] for case in cases}) > 1]
    if len(moving) != 2:
        return None
    row_key, column_key = moving
    rows, columns = (_ordered(key, cases) for key in moving)
    by_place = {(case.parameters[row_key], case.parameters[column_key]): case for case in cases}
    if len(by_place) < len(cases):
        return None
    cells = [[by_place.get((row, column)) for column in columns] for row in rows]
    return CaseMap(scenario, row_key, column_key, rows, columns, cells)


def _ordered(key: str, cases: Iterable[evaluation.CaseResult]) -> list[str]:
    """Return the texts of a swept key by their numbers, where all of them are; else as they came."""
    numbers = {case.parameters[key]: _number(key, case) for case in cases}
    known = {text: number for text, number in numbers.items() if number is not None}
    return sorted(known, key=lambda text: known[text]) if len(known) == len(numbers) else list(numbers)


def _number(key: str, case: evaluation.CaseResult) -> float | None:
    """Return the number that a case was run with for a key; None where it is none or not known."""
    values = (each.value for part in case.parts.values() for each in part.parameters if each.key == key)
    number = next(values, None)
    return number if isinstance(number, int | float) else None


_MOST: Final = 100
"""Parts that a page shows: each takes up to 10 kB of it."""


@dataclass(frozen=True, slots=True)
class ShownParts:
    """The parts that a page shows in full, and how many more there are that it does not show."""

    parts: Sequence[evaluation.EffectivePart]
    not_shown: int

    def __contains__(self, part: evaluation.EffectivePart) -> bool:
        """Whether the page shows a part, so that a link to it leads somewhere."""
        return any(each.id == part.id for each in self.parts)


def shown_parts(cases: Iterable[Mapping[str, evaluation.EffectivePart]]) -> ShownParts:
    """Return the distinct parts of some cases for a page to show: by kind, each in the order of first use."""
    table = evaluation.parts_table(cases)
    parts = list(table.values())[:_MOST]
    kinds = list(dict.fromkeys(part.kind for part in parts))
    return ShownParts(sorted(parts, key=lambda part: kinds.index(part.kind)), len(table) - len(parts))
