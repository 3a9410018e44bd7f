"""Maps: cases of one scenario that fill a table of two swept keys."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from uictest import evaluation


@dataclass(frozen=True, slots=True)
class Map:
    """Cases of a scenario by two keys; `cells[row][column]` is None where there is no such case."""

    scenario: str
    row_key: str
    column_key: str
    rows: Sequence[str]
    columns: Sequence[str]
    cells: Sequence[Sequence[evaluation.CaseResult | None]]


def maps_of(results: Iterable[evaluation.CaseResult]) -> list[Map]:
    """Return a map for every scenario whose cases vary in exactly two keys, two values of each or more."""
    by_sweep: dict[tuple[str, ...], list[evaluation.CaseResult]] = {}
    for result in results:
        by_sweep.setdefault((result.scenario, *result.parameters), []).append(result)
    return [found for sweep, cases in by_sweep.items() if (found := _map(sweep[0], sweep[1:], cases))]


def _map(scenario: str, keys: Sequence[str], cases: Sequence[evaluation.CaseResult]) -> Map | None:
    moving = [key for key in keys if len({case.parameters[key] for case in cases}) > 1]
    if len(moving) != 2:
        return None
    row_key, column_key = moving
    rows, columns = (_ordered({case.parameters[key]: None for case in cases}) for key in moving)
    by_place = {(case.parameters[row_key], case.parameters[column_key]): case for case in cases}
    if len(by_place) < len(cases):
        return None
    cells = [[by_place.get((row, column)) for column in columns] for row in rows]
    return Map(scenario, row_key, column_key, rows, columns, cells)


def _ordered(texts: Iterable[str]) -> list[str]:
    """Return texts by the number they begin with, where all do; else as they came."""
    found = list(texts)
    try:
        return sorted(found, key=lambda text: float(text.split()[0]))
    except (ValueError, IndexError):
        return found
