"""Cells of heat maps against counts by hand, and against the rows they come from."""

import math

import numpy as np
import pytest

from uictest.report.sweep.cases import SummaryRows, reported_columns
from uictest.report.sweep.map_cells import MOST_VALUES, map_cells, mapped_pairs

from ..sweep_rows import DRAWN, drawn_rows, row, sweep_result, write_rows

VALUES = {"friction": ["0.1", "0.2"], "command": ["80 %", "90 %", "100 %"], "topology": ["one", "four"]}


def at(friction, command, topology, outcome, distance=None):
    own = {"friction": friction, "command": command, "topology": topology}
    parameters = {f"parameters.{key}": text for key, text in own.items()}
    return row(f"{friction}{command}{topology}", outcome, **parameters, braking_distance_m=distance)


ROWS = [
    at("0.1", "80 %", "one", "pass", 100.0),
    at("0.1", "80 %", "four", "fail", 140.0),
    at("0.1", "90 %", "one", "error"),
    at("0.1", "90 %", "four", "pass", 90.0),
    at("0.2", "80 %", "one", "skipped"),
    at("0.2", "90 %", "one", "pass", 70.0),
    at("0.2", "90 %", "four", "inconclusive", math.nan),
]


def test_a_cell_has_the_counts_and_the_mean_of_its_cases(tmp_path):
    write_rows(tmp_path, ROWS)
    result = sweep_result(VALUES, len(ROWS))
    pairs = [("friction", "command")]
    (cells, *_) = map_cells(result, SummaryRows(tmp_path), pairs, reported_columns(result))
    assert cells.cases.tolist() == [[2, 2, 0], [1, 2, 0]]
    assert cells.met.tolist() == [[1, 1, 0], [0, 1, 0]]
    assert cells.outcomes["error"].tolist() == [[0, 1, 0], [0, 0, 0]]
    assert cells.outcomes["inconclusive"].tolist() == [[0, 0, 0], [0, 1, 0]]
    np.testing.assert_array_equal(
        cells.means["braking distance"], [[120.0, 90.0, math.nan], [math.nan, 70.0, math.nan]]
    )
    # What is not judged, or not there, has no verdict.
    assert cells.verdicts.tolist() == [[0, 0, -1], [-1, 0, -1]]


def test_every_row_is_in_one_cell_of_every_pair(tmp_path):
    rows = drawn_rows(500, failing=range(0, 500, 7))
    write_rows(tmp_path, rows)
    result = sweep_result(DRAWN, len(rows))
    (cells,) = map_cells(result, SummaryRows(tmp_path), mapped_pairs(result), reported_columns(result))
    frictions = np.array([float(each["parameters.rail.friction"]) for each in rows])
    gains = np.array([float(each["parameters.gain"].split()[0]) for each in rows])
    counts, *_ = np.histogram2d(frictions, gains, [np.linspace(0.1, 0.2, 11), [0.01, 0.1, 1.0]])
    assert cells.cases.tolist() == counts.tolist()
    assert (cells.cases - cells.met).sum() == len(range(0, 500, 7))
    known = np.isfinite(cells.means["braking distance"])
    total = np.sum(cells.means["braking distance"][known] * cells.cases[known])
    assert total == pytest.approx(sum(each["braking_distance_m"] for each in rows))
    # The larger of two wheelsets, shown in per cent.
    assert cells.means["largest slide"][known] == pytest.approx(25.0)


def test_neighbours_share_a_cell_where_there_are_many_values(tmp_path):
    numbers = [str(k) for k in range(2 * MOST_VALUES + 1)]
    rows = [
        row(text, **{"parameters.a": text, "parameters.b": "1"}, braking_distance_m=1.0 * k)
        for k, text in enumerate(numbers)
    ]
    write_rows(tmp_path, rows)
    result = sweep_result({"a": numbers, "b": ["1", "2"]}, len(rows))
    (cells,) = map_cells(result, SummaryRows(tmp_path), [("a", "b")], reported_columns(result))
    assert cells.rows.is_folded
    assert not cells.columns.is_folded
    assert [len(group) for group in cells.rows.groups] == [3] * 40 + [1]
    assert cells.means["braking distance"][:2, 0].tolist() == [1.0, 4.0]
    assert cells.rows.place_of("4") == 1
    assert cells.rows.place_of("x") is None


def test_a_value_that_the_result_does_not_have_is_refused(tmp_path):
    write_rows(tmp_path, [at("0.3", "80 %", "one", "pass")])
    result = sweep_result(VALUES, 1)
    with pytest.raises(ValueError, match="a value of friction is not in the result"):
        map_cells(result, SummaryRows(tmp_path), [("friction", "command")], [])


def test_every_pair_is_mapped_and_that_of_the_result_comes_first():
    axes = {
        name: {"parameter": key, "values": VALUES[key]}
        for name, key in (("rows", "topology"), ("columns", "friction"))
    }
    maps = [{"measure": "met", **axes, "means": [], "met": [], "cases": []}]
    result = sweep_result(VALUES | {"seed": ["1"]}, 12, maps=maps)
    # One value makes no axis.
    pairs = ["topology friction", "friction command", "command topology"]
    assert list(map(" ".join, mapped_pairs(result))) == pairs
