"""Heat maps: the boundary of the verdict, the values, the marks, the colours."""

import re
from collections import Counter

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from uictest.report.page.sweep.cell_axis import placed_cells
from uictest.report.page.sweep.heat import heat_maps
from uictest.report.page.sweep.heat_plot import boundary_path
from uictest.report.sweep.map_cells import CellAxis, MapCells
from uictest.report.sweep.values import WrittenValue


def axis(key, count):
    return CellAxis(key, [(WrittenValue(str(k + 1)),) for k in range(count)])


def cells(met, cases, outcomes=None, **means):
    met, cases = np.array(met), np.array(cases)
    known = {name: np.array(counts) for name, counts in (outcomes or {}).items()}
    rows, columns = cases.shape
    figures = {name: np.array(each, float) for name, each in means.items()}
    return MapCells(axis("a", rows), axis("b", columns), cases, met, known, figures)


def maps_of(found, **others):
    units, stops = others.pop("units", {}), others.pop("stops", {})
    return heat_maps(found, units, stops, others.pop("logarithmic", ()), others.pop("varied", ("a", "b")))


def edges_of(path):
    """Return the lines of a path as pairs of points."""
    edges = Counter()
    for x, y, kind, end in re.findall(r"M([\d.]+) ([\d.]+)([VH])([\d.]+)", path):
        start = (float(x), float(y))
        stop = (start[0], float(end)) if kind == "V" else (float(end), start[1])
        edges[min(start, stop), max(start, stop)] += 1
    return edges


def expected_edges(verdicts, across, down):
    """Go around every cell that is met, and keep the sides behind which a cell is not met."""
    edges = Counter()
    rows, columns = verdicts.shape
    for row in range(rows):
        for column in range(columns):
            (x0, x1), (y0, y1) = across.span(column), down.span(row)
            # Rows rise upwards, so that the next row lies above.
            sides = {(1, 0): ((x0, y0), (x1, y0)), (-1, 0): ((x0, y1), (x1, y1))}
            sides |= {(0, 1): ((x1, y0), (x1, y1)), (0, -1): ((x0, y0), (x0, y1))}
            for (up, right), side in sides.items():
                beyond = (row + up, column + right)
                inside = 0 <= beyond[0] < rows and 0 <= beyond[1] < columns
                if verdicts[row, column] == 1 and inside and verdicts[beyond] == 0:
                    edges[tuple(tuple(round(at, 1) for at in point) for point in side)] += 1
    return edges


def placed(shape):
    return (
        placed_cells(axis("b", shape[1]), (), 50.0, 350.0),
        placed_cells(axis("a", shape[0]), (), 250.0, 30.0, upright=True),
    )


def test_the_boundary_of_a_known_grid():
    """Met below a diagonal: three steps, each an upright and a level line."""
    across, down = placed((3, 3))
    verdicts = np.array([[1, 1, 1], [1, 1, 0], [1, 0, 0]])
    x, y = across.edges, down.edges
    lines = [((x[2], y[2]), (x[2], y[1])), ((x[2], y[1]), (x[3], y[1])), ((x[1], y[3]), (x[1], y[2]))]
    lines += [((x[1], y[2]), (x[2], y[2]))]
    rounded = [sorted(tuple(round(at, 1) for at in point) for point in line) for line in lines]
    assert sorted(map(list, edges_of(boundary_path(verdicts, across, down)))) == sorted(rounded)


@given(
    arrays(np.int8, array_shapes(min_dims=2, max_dims=2, min_side=2, max_side=7), elements=st.integers(-1, 1))
)
def test_the_boundary_runs_between_met_and_not_met_and_nowhere_else(verdicts):
    across, down = placed(verdicts.shape)
    assert edges_of(boundary_path(verdicts, across, down)) == expected_edges(verdicts, across, down)


@pytest.mark.parametrize("verdicts", [[[1, 1], [1, 1]], [[0, 0], [0, 0]], [[1, -1], [-1, 0]]])
def test_without_a_change_there_is_no_boundary(verdicts):
    """Cells without a case, or not judged, are on neither side."""
    assert boundary_path(np.array(verdicts), *placed((2, 2))) == ""


def drawn_cells(found):
    return sum(path.count("M") for path in found.plot.fills.values())


@given(st.integers(1, 8), st.integers(2, 8), st.data())
def test_every_cell_is_drawn_once_and_in_the_table(rows, columns, data):
    cases = data.draw(arrays(np.int64, (rows, columns), elements=st.integers(0, 3)))
    missing = data.draw(arrays(np.bool_, (rows, columns)))
    means = np.where(missing | (cases == 0), np.nan, np.arange(rows * columns).reshape(rows, columns) + 0.5)
    verdicts, distances = maps_of(cells(np.minimum(cases, 2), cases, distance=means)).maps
    empty, unknown = int((cases == 0).sum()), int(((cases > 0) & missing).sum())
    assert drawn_cells(verdicts) == rows * columns - empty
    assert drawn_cells(distances) == rows * columns - empty - unknown
    assert distances.plot.no_case.count("M") == empty
    assert distances.plot.no_value.count("M") == unknown
    shown = [[cell.text for cell in row] for _, row in distances.rows]
    expected = [
        ["" if not n else "–" if v != v else f"{v:.4g}" for v, n in zip(*line, strict=True)]  # noqa: RUF001
        for line in zip(means.tolist(), cases.tolist(), strict=True)
    ]
    assert shown == expected


def test_values_stand_in_all_cells_or_in_none():
    def printed(columns, value):
        ones = np.ones((2, columns), int)
        (_, found) = maps_of(cells(ones, ones, distance=np.full((2, columns), value))).maps
        return [each.text for each in found.plot.texts]

    assert printed(15, 1621.3) == ["1621"] * 30
    assert printed(60, 1621.3) == []
    assert printed(15, 0.12345) == []
    assert printed(4, 0.12345) == ["0.123"] * 8


def test_cells_say_their_cases_and_lead_to_a_drawn_stop():
    outcomes = {"pass": [[3, 0]], "fail": [[1, 0]], "error": [[1, 0]], "skipped": [[0, 1]]}
    found = maps_of(cells([[3, 1]], [[5, 1]], outcomes), stops={(0, 0): "case-3"})
    ((label, (first, second)),) = found.maps[0].rows
    assert (label, first.stop) == ("1", "case-3")
    assert (first.text, first.detail) == ("60 %", "3 of 5 met, 1 fail, 1 error")
    assert (second.text, second.detail, second.stop) == ("100 %", "skipped", "")
    assert [each.text for each in found.maps[0].plot.signs] == ["×◐", "○"]  # noqa: RUF001
    assert found.signs == [
        ("×", "1 cell with an error"),  # noqa: RUF001
        ("○", "1 cell with a case that is not judged"),
        ("◐", "1 cell in which only some cases met their expectation"),
    ]
    all_and_none = maps_of(cells([[3, 0, 2]], [[3, 3, 3]]))  # are not mixed
    signs = [(each.text, round(each.x)) for each in all_and_none.maps[0].plot.signs]
    assert (signs, all_and_none.has_boundary) == ([("◐", 391)], True)


def test_what_a_cell_stands_for_is_stated():
    folded = CellAxis("a", [(WrittenValue("1"), WrittenValue("2")), (WrittenValue("3"),)])
    found = MapCells(
        folded, axis("b", 2), np.full((2, 2), 4), np.full((2, 2), 4), {}, {"distance": np.ones((2, 2))}
    )
    shown = maps_of(found, varied=("a", "b", "c", "d"), units={"distance": "m"})
    assert shown.name == "a (up) against b (across)"
    assert shown.notes == [
        "A cell has all cases with its two values, whatever their c, d.",
        "Folded: neighbours of 3 values of a share 2 cells.",
    ]
    assert [each.title for each in shown.maps] == ["cases met, %", "mean distance, m"]
    listed = CellAxis("a", [(WrittenValue(text),) for text in ("none", "full")])
    of_list = MapCells(listed, axis("b", 2), np.ones((2, 2), int), np.ones((2, 2), int), {}, {})
    assert maps_of(of_list).name == "a (down) against b (across)"
    assert shown.maps[1].anchor == "map-distance-a-b"


def test_what_differs_by_rounding_has_one_colour():
    """0.1 + 0.2 is not 0.3 in floats: a mean over other cases would have the other end of the scale."""
    [_, found] = maps_of(cells([[1, 1]], [[1, 1]], distance=[[0.3, 0.1 + 0.2]])).maps
    assert len(found.plot.fills) == 1
    assert len({label for _, label in found.plot.bar_ticks}) == len(found.plot.bar_ticks)


def test_the_colour_bar_spans_the_values():
    ones = np.ones((1, 2), int)
    (shares, distances) = maps_of(cells(ones, ones, distance=[[200.0, 400.0]])).maps
    assert [label for _, label in distances.plot.bar_ticks] == ["200", "250", "300", "350", "400"]
    assert [label for _, label in shares.plot.bar_ticks] == ["0", "20", "40", "60", "80", "100"]
    bar = distances.plot.bar
    assert [next(iter(distances.plot.fills)), list(distances.plot.fills)[-1]] == [bar[0][0], bar[-1][0]]


def test_a_logarithmic_parameter_has_a_logarithmic_axis():
    rows = CellAxis("a", [(WrittenValue(text),) for text in ("0.1", "1", "10")])
    ones = np.ones((3, 2), int)
    found = MapCells(rows, axis("b", 2), ones, ones, {}, {})
    plot = maps_of(found, logarithmic=("a",)).maps[0].plot
    assert (plot.down.spacing, plot.across.spacing) == ("logarithmic", "linear")
    assert np.diff(plot.down.edges) == pytest.approx([np.diff(plot.down.edges)[0]] * 3)


def test_values_that_differ_little_have_the_digits_that_tell_them_apart():
    ones = np.ones((1, 2), int)
    shown = maps_of(cells(ones, ones, distance=[[469.61, 469.63]])).maps[1]
    assert [each.text for each in shown.plot.texts] == ["469.61", "469.63"]
    assert [cell.text for cell in shown.rows[0][1]] == ["469.61", "469.63"]
    labels = [label for _, label in shown.plot.bar_ticks]
    assert len(set(labels)) == len(labels)
