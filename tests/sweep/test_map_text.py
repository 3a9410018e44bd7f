from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.sweep.map_text import fold, folded_label, map_lines
from uictest.sweep.summaries.bins import ParameterBins
from uictest.sweep.summaries.maps import MapSums

_RANGE = re.compile(r"(\S+) \.\. (\S+) \((\d+) values\)")


def _map(rows: int, columns: int, measure: str = "braking_distance_m") -> MapSums:
    """A map of one case per cell whose figure is 1000 x row + column."""
    axes = [
        ParameterBins(key, tuple(f"{0.06 + 0.005 * k:.3f}" for k in range(count)), (0, 0))
        for key, count in (("rail.friction", rows), ("brake.command", columns))
    ]
    made: Any = MapSums(None, *axes, measure)  # type: ignore[arg-type]
    made._sum += 1000.0 * np.arange(rows)[:, None] + np.arange(columns)
    made._known += 1
    return made


def _covered(label: str, labels: tuple[str, ...]) -> list[str]:
    """Return the values that a label claims, as a reader takes it."""
    match = _RANGE.fullmatch(label)
    if match is None:
        return [label]
    values = list(labels[labels.index(match[1]) : labels.index(match[2]) + 1])
    assert len(values) == int(match[3])
    return values


@pytest.mark.parametrize("rows", [2, 24, 25, 31, 60, 100])
def test_each_row_is_labelled_by_exactly_the_values_it_shows(rows: int) -> None:
    found = _map(rows, 2)
    labels = found.rows.labels
    lines = [line for line in map_lines(found, None) if re.match(r" *0\.\d+ .* \d", line)]
    claimed = []
    for line in lines[-len(fold(rows, 24)) :]:
        label, first, _ = re.split(r"  +", line.strip())
        values = _covered(label, labels)
        claimed += values
        assert float(first) == pytest.approx(
            1000.0 * np.mean([labels.index(each) for each in values]), rel=1e-3
        )
    assert claimed == list(labels)


@pytest.mark.parametrize(
    ("columns", "width"), [(2, None), (25, None), (31, None), (31, 80), (31, 40), (9, 30)]
)
def test_each_column_is_headed_by_exactly_the_values_it_shows(columns: int, width: int | None) -> None:
    found = _map(2, columns)
    labels = found.columns.labels
    *_, first_row, _ = lines = list(map_lines(found, width))
    heads = lines[lines.index(first_row) - 2 : -2]
    firsts, lasts = heads if heads[1].strip().startswith("..") else (heads[1], "")
    cells = first_row.split()[1:]
    starts, ends = firsts.split(), lasts.replace(".. ", "").split()
    ends += starts[len(ends) :]  # a last column of one value has no second line
    assert len(starts) == len(ends) == len(cells)
    claimed = []
    for start, end, cell in zip(starts, ends, cells, strict=True):
        values = labels[labels.index(start) : labels.index(end) + 1]
        claimed += values
        assert float(cell) == pytest.approx(np.mean([labels.index(each) for each in values]), rel=1e-3)
    assert claimed == list(labels)


@pytest.mark.parametrize("width", [40, 60, 80, 120])
def test_a_map_keeps_to_the_width_of_the_terminal(width: int) -> None:
    _, remark, *table = map_lines(_map(31, 31), width)
    assert max(map(len, table)) <= width
    assert "31 values of rail.friction in 16 rows" in remark
    assert "map-braking_distance_m.csv has every value" in remark


def test_a_map_with_room_for_every_value_is_not_folded() -> None:
    lines = list(map_lines(_map(3, 3), None))
    assert len(lines) == 1 + 1 + 3
    assert "folded" not in "".join(lines)


def test_stretches_of_drawn_numbers_fold_into_longer_stretches() -> None:
    assert folded_label(["0.06 .. 0.07", "0.07 .. 0.08"]) == "0.06 .. 0.08"
    assert folded_label(["60 .. 70 %"]) == "60 .. 70 %"
    assert folded_label(["dry", "wet"]) == "dry .. wet (2 values)"


@given(st.integers(1, 300), st.integers(1, 30))
def test_a_fold_holds_every_value_once_in_order(values: int, most: int) -> None:
    places = fold(values, most)
    assert [each for group in places for each in group] == list(range(values))
    assert len(places) <= most
