"""What is said of a car of a train: its place and the largest forces in its couplers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from uictest.core.document import Cell
from uictest.judging import evaluation

TRAIN_COLUMNS: Final = (
    *("train", "cars"),
    *(f"coupler_{side}_{what}_n" for side in ("ahead", "behind") for what in ("pull", "push")),
)
"""Columns of tables with cars of trains: the largest force of each kind in the coupler on each side."""


def any_in_train(results: Iterable[evaluation.CaseResult]) -> bool:
    """Return whether any case is a car of a train."""
    return any(result.train is not None for result in results)


def train_cells(result: evaluation.CaseResult) -> dict[str, Cell]:
    """Return the cells of `TRAIN_COLUMNS`; none for a car alone."""
    if result.train is None:
        return {}
    cells: dict[str, Cell] = {"train": result.train.train, "cars": result.train.cars}
    for side, forces in result.train.couplers:
        cells[f"coupler_{side}_pull_n"] = forces.largest_pull_n
        cells[f"coupler_{side}_push_n"] = forces.largest_push_n
    return cells


def train_facts(result: evaluation.CaseResult) -> Iterator[tuple[str, str]]:
    """Yield where a car runs and the largest forces in its couplers, each with its name."""
    if result.train is None:
        return
    yield "place", f"{result.train.label} of {result.train.train}"
    for side, forces in result.train.couplers:
        yield f"coupler {side}", f"largest {forces}"


def train_text(result: evaluation.CaseResult) -> str:
    """Return the place of a car and its coupler forces in one line; empty for a car alone."""
    if result.train is None:
        return ""
    couplers = (f"coupler {side}: {forces}" for side, forces in result.train.couplers)
    return "; ".join([result.train.label, *couplers])
