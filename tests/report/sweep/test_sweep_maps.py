"""Maps of a sweep: cells against counts by hand and against their rows, folded, and as lines of text."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.report import MapAxis, SweepMap, WrittenValue
from uictest.report.sweep.cases import SummaryRows, reported_columns
from uictest.report.sweep.sweep_maps import (
    MOST_SHOWN,
    MOST_VALUES,
    cells_of_maps,
    fold,
    folded,
    is_large,
    map_cells,
    map_lines,
    mapped_pairs,
    short_label,
)

from ..sweep_rows import INTERVALS, drawn_rows, row, sweep_result, write_rows

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
    (cells,) = map_cells(result, SummaryRows(tmp_path), pairs, reported_columns(result))
    assert cells.cases.tolist() == [[2, 2, 0], [1, 2, 0]]
    assert cells.met.tolist() == [[1, 1, 0], [0, 1, 0]]
    assert cells.outcomes["error"].tolist() == [[0, 1, 0], [0, 0, 0]]
    assert cells.outcomes["inconclusive"].tolist() == [[0, 0, 0], [0, 1, 0]]
    distances = [[120.0, 90.0, math.nan], [math.nan, 70.0, math.nan]]
    np.testing.assert_array_equal(cells.means["braking distance"], distances)
    # What is not judged, or not there, has no verdict.
    assert cells.verdicts.tolist() == [[0, 0, -1], [-1, 0, -1]]


def test_every_row_is_in_one_cell_of_every_pair(tmp_path):
    rows = drawn_rows(500, failing=range(0, 500, 7))
    write_rows(tmp_path, rows)
    result = sweep_result(INTERVALS, len(rows))
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
    assert (cells.rows.is_folded, cells.columns.is_folded) == (True, False)
    assert [len(group) for group in cells.rows.groups] == [3] * 40 + [1]
    assert cells.means["braking distance"][:2, 0].tolist() == [1.0, 4.0]
    assert (cells.rows.place_of("4"), cells.rows.place_of("x")) == (1, None)


def test_a_value_that_the_result_does_not_have_is_refused(tmp_path):
    write_rows(tmp_path, [at("0.3", "80 %", "one", "pass")])
    with pytest.raises(ValueError, match="a value of friction is not in the result"):
        map_cells(sweep_result(VALUES, 1), SummaryRows(tmp_path), [("friction", "command")], [])


def test_every_pair_is_mapped_that_of_the_result_first_with_the_cells_of_all_its_measures():
    keys = (("rows", "topology"), ("columns", "friction"))
    axes = {name: {"parameter": key, "values": VALUES[key]} for name, key in keys}
    maps = [{"measure": "met", **axes, "means": [], "met": [], "cases": []}]
    result = sweep_result(VALUES | {"seed": ["1"]}, 12, maps=maps)
    # One value makes no axis.
    pairs = ["topology friction", "friction command", "command topology"]
    assert list(map(" ".join, mapped_pairs(result))) == pairs
    maps = [made_up_map(2, 3, "met"), made_up_map(2, 3), made_up_map(2, 3, "largest")]
    cells = cells_of_maps(maps, [])
    assert list(cells.means) == ["braking distance, m", "largest"]
    assert (cells.outcomes, cells.met.tolist()) == ({}, [[1, 1, 1]] * 2)


def made_up_map(rows, columns, measure="braking_distance_m"):
    """A map of one case per cell whose measure is 1000 x row + column."""
    axes = [
        MapAxis(key, tuple(WrittenValue(f"{0.06 + 0.005 * k:.3f}") for k in range(count)))
        for key, count in (("rail.friction", rows), ("brake.command", columns))
    ]
    means = (1000.0 * np.arange(rows)[:, None] + np.arange(columns)).tolist()
    ones = [[1] * columns] * rows
    return SweepMap(measure, *axes, means, ones, ones, ones)


@given(st.integers(1, 60), st.integers(1, 60), st.integers(1, 30))
def test_folded_cells_hold_every_case_once_and_their_mean(rows, columns, most):
    whole = made_up_map(rows, columns)
    cells = folded(whole, most)
    assert max(cells.cases.shape) <= most
    assert is_large(whole) == (max(rows, columns) > MOST_SHOWN)
    assert cells.cases.shape == (len(cells.rows.groups), len(cells.columns.groups))
    assert cells.cases.sum() == cells.met.sum() == rows * columns
    total = (cells.means["braking_distance_m"] * cells.cases).sum()
    assert total == pytest.approx(np.sum(whole.means))
    if max(rows, columns) <= most:
        assert cells.means["braking_distance_m"].tolist() == whole.means


def test_a_fold_is_named_by_its_ends_and_a_mean_counts_the_cases_that_have_the_measure():
    assert list(map(short_label, folded(made_up_map(3, 1), 2).rows.groups)) == ["0.060 … 0.065", "0.070"]
    two = replace(made_up_map(2, 1), means=[[1.0], [4.0]], cases=[[10], [10]], known=[[1], [2]])
    assert folded(two, 1).means["braking_distance_m"].tolist() == [[3.0]]
    # Read from a file: the cases that have the measure are not known, those without a mean have none.
    unknown = replace(made_up_map(2, 2), means=[[None, 3.0], [5.0, None]], cases=[[9, 1], [3, 9]], known=None)
    assert folded(unknown, 1).means["braking_distance_m"].tolist() == [[4.5]]
    assert np.isnan(folded(replace(unknown, means=[[None] * 2] * 2), 1).means["braking_distance_m"]).all()


@given(st.integers(1, 300), st.integers(1, 30))
def test_a_fold_holds_every_value_once_in_order(values, most):
    groups = fold(values, most)
    assert [index for group in groups for index in group] == list(range(values))
    assert len(groups) <= most


RANGE = re.compile(r"(\S+) \.\. (\S+) \((\d+) values\)")


def labels_of(axis):
    return [value.label for value in axis.values]


def claimed(label, labels):
    """Return the values that a label claims, as a reader takes it."""
    match = RANGE.fullmatch(label)
    if match is None:
        return [label]
    values = labels[labels.index(match[1]) : labels.index(match[2]) + 1]
    assert len(values) == int(match[3])
    return values


@pytest.mark.parametrize("rows", [2, 24, 25, 31, 60, 100])
def test_each_row_is_labelled_by_exactly_the_values_it_shows(rows):
    sweep_map = made_up_map(rows, 2)
    labels = labels_of(sweep_map.rows)
    lines = [line for line in map_lines(sweep_map, None) if re.match(r" *0\.\d+ .* \d", line)]
    shown = []
    for line in lines[-len(fold(rows, 24)) :]:
        label, first, _ = re.split(r"  +", line.strip())
        values = claimed(label, labels)
        shown += values
        mean = 1000.0 * np.mean([labels.index(value) for value in values])
        assert float(first) == pytest.approx(mean, rel=1e-3)
    assert shown == labels


@pytest.mark.parametrize(
    ("columns", "width"), [(2, None), (25, None), (31, None), (31, 80), (31, 40), (9, 30)]
)
def test_each_column_is_headed_by_exactly_the_values_it_shows(columns, width):
    sweep_map = made_up_map(2, columns)
    labels = labels_of(sweep_map.columns)
    *_, first_row, _ = lines = list(map_lines(sweep_map, width))
    heads = lines[lines.index(first_row) - 2 : -2]
    firsts, lasts = heads if heads[1].strip().startswith("..") else (heads[1], "")
    cells = first_row.split()[1:]
    starts, ends = firsts.split(), lasts.replace(".. ", "").split()
    ends += starts[len(ends) :]  # a last column of one value has no second line
    shown = []
    for start, end, cell in zip(starts, ends, cells, strict=True):
        values = labels[labels.index(start) : labels.index(end) + 1]
        shown += values
        assert float(cell) == pytest.approx(np.mean([labels.index(value) for value in values]), rel=1e-3)
    assert shown == labels


@pytest.mark.parametrize("width", [40, 60, 80, 120])
def test_a_map_keeps_to_the_width_of_the_terminal_and_only_what_is_whole_is_shown_as_whole(width):
    lines = list(map_lines(made_up_map(31, 31), width))
    assert max(map(len, lines)) <= width
    said = " ".join(" ".join(lines).split())
    assert "31 values of rail.friction in 16 rows" in said
    assert "tables/map-braking_distance_m.csv has every value" in said
    small = list(map_lines(made_up_map(3, 3), width))
    assert "folded" not in "".join(small)
    shares = [[0.0, 0.001, 0.5, 0.999, 1.0, None]]
    what, _, line = map_lines(replace(made_up_map(1, 6, "met"), means=shares), None)
    marks = ". all, 1-9 tenths, # none, ? no valid test"
    assert what == f"share met ({marks}): rail.friction down, brake.command across"
    assert line.split()[1:] == ["#", "1", "5", "9", "."]
    none_valid = replace(made_up_map(1, 6, "met"), means=shares, valid=[[0, 9, 9, 9, 9, 0]])
    *_, line = map_lines(none_valid, None)
    assert line.split()[1:] == ["?", "1", "5", "9", "."]
