import re

import numpy as np
import pytest

from uictest.report import MapAxis, SweepMap, WrittenValue, map_lines
from uictest.report.sweep.map_text import fold

_RANGE = re.compile(r"(\S+) \.\. (\S+) \((\d+) values\)")


def _map(rows, columns, measure="braking_distance_m"):
    """A map of one case per cell whose measure is 1000 x row + column."""
    axes = [
        MapAxis(key, tuple(WrittenValue(f"{0.06 + 0.005 * k:.3f}") for k in range(count)))
        for key, count in (("rail.friction", rows), ("brake.command", columns))
    ]
    means = (1000.0 * np.arange(rows)[:, None] + np.arange(columns)).tolist()
    ones = [[1] * columns] * rows
    return SweepMap(measure, *axes, means, ones, ones, ones)


def _labels(axis):
    return tuple(value.label for value in axis.values)


def _covered(label, labels):
    """Return the values that a label claims, as a reader takes it."""
    match = _RANGE.fullmatch(label)
    if match is None:
        return [label]
    values = list(labels[labels.index(match[1]) : labels.index(match[2]) + 1])
    assert len(values) == int(match[3])
    return values


@pytest.mark.parametrize("rows", [2, 24, 25, 31, 60, 100])
def test_each_row_is_labelled_by_exactly_the_values_it_shows(rows):
    sweep_map = _map(rows, 2)
    labels = _labels(sweep_map.rows)
    lines = [line for line in map_lines(sweep_map, None) if re.match(r" *0\.\d+ .* \d", line)]
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
def test_each_column_is_headed_by_exactly_the_values_it_shows(columns, width):
    sweep_map = _map(2, columns)
    labels = _labels(sweep_map.columns)
    *_, first_row, _ = lines = list(map_lines(sweep_map, width))
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
def test_a_map_keeps_to_the_width_of_the_terminal(width):
    _, remark, *table = map_lines(_map(31, 31), width)
    assert max(map(len, table)) <= width
    assert "31 values of rail.friction in 16 rows" in remark
    assert "map-braking_distance_m.csv has every value" in remark
    small = list(map_lines(_map(3, 3), width))
    assert len(small) == 1 + 1 + 3
    assert "folded" not in "".join(small)
