from dataclasses import replace

import pytest
from hypothesis import given, strategies as st

from uictest.report import MapAxis, SweepMap, WrittenValue
from uictest.report.sweep.map_text import MOST_SHOWN, fold, folded, is_large, short_label


def _map(rows, columns):
    axes = [
        MapAxis(name, tuple(WrittenValue(str(k)) for k in range(count)))
        for name, count in (("rows", rows), ("columns", columns))
    ]
    cells = [[row * columns + column for column in range(columns)] for row in range(rows)]
    means = [[float(cell) if cell else None for cell in row] for row in cells]
    return SweepMap("met", *axes, means, cells, cells)


def test_a_small_map_stays_as_it_is():
    shown, whole = folded(_map(24, 2)), _map(24, 2)
    assert (shown.means, shown.met, shown.cases) == (whole.means, whole.met, whole.cases)
    assert [short_label(values) for values in shown.rows] == [value.label for value in whole.rows.values]


@given(st.integers(1, 60), st.integers(1, 60), st.integers(1, 30))
def test_folded_cells_hold_every_case_once(rows, columns, most):
    shown = folded(_map(rows, columns), most)
    assert max(len(shown.rows), len(shown.columns)) <= most
    assert is_large(_map(rows, columns)) == (max(rows, columns) > MOST_SHOWN)
    assert sum(map(sum, shown.cases)) == sum(range(rows * columns))
    assert len(shown.cases) == len(shown.means) == len(shown.rows)
    assert {len(row) for row in shown.means} == {len(shown.columns)}


def test_a_fold_is_named_by_its_ends_and_has_the_mean_of_its_cases():
    shown = folded(_map(3, 2), 2)
    assert list(map(short_label, shown.rows)) == ["0 … 1", "2"]
    # Cells 0 (no case, no mean) and 2 (two cases), then 1 and 3.
    assert shown.means[0] == [2.0, pytest.approx((1 + 9) / 4)]
    assert shown.means[1] == [4.0, 5.0]


def test_a_mean_counts_the_cases_that_have_the_measure():
    sweep_map = replace(_map(2, 1), means=[[1.0], [4.0]], cases=[[10], [10]], known=[[1], [2]])
    assert folded(sweep_map, 1).means == [[3.0]]
    assert folded(replace(_map(4, 1), means=[[None]] * 4), 2).means == [[None], [None]]


@given(st.integers(1, 300), st.integers(1, 30))
def test_a_fold_holds_every_value_once_in_order(values, most):
    places = fold(values, most)
    assert [each for group in places for each in group] == list(range(values))
    assert len(places) <= most
