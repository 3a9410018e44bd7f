"""The plots of a sweep: every line and band lies where its numbers are, and says them."""

import re

import numpy as np
import pytest
from pydantic import TypeAdapter

from uictest.report import Frontier, OutcomeCount, SweptValue, Trend, WrittenValue
from uictest.report.page.sweep_lines import MOST_LINES, cell_lines, frontier_plot, trend_plot
from uictest.report.sweep.sweep_maps import CellAxis, MapCells

NAN = float("nan")


def of_json(kind, form):
    """Return what stands in `results.json` in this form."""
    return TypeAdapter(kind).validate_python(form)


def start(shape):
    """Return where a path begins, in pixels."""
    return tuple(map(float, re.match(r"M([\d.]+) ([\d.]+)", shape.path).groups()))


def of_kind(plot, kind):
    return [shape for shape in plot.shapes if kind in shape.kind.split()]


def axis(key, *texts):
    return CellAxis(key, [(WrittenValue(text),) for text in texts])


def lines_of(rows, columns, means, cases=1):
    counts = np.full((len(rows.groups), len(columns.groups)), cases)
    cells = MapCells(rows, columns, counts, counts, {}, {"distance": np.array(means)})
    return cell_lines(cells, {"distance": "m"}, ())


def test_every_point_of_a_line_is_the_value_of_one_cell():
    command, friction = axis("command", "80 %", "100 %"), axis("friction", "0.12", "0.08", "0.10")
    drawn = lines_of(command, friction, [[3.0, 1.0, 2.0], [6.0, 4.0, 5.0]])
    (plot,) = drawn.plots
    assert [name for _, name in drawn.key] == ["80 %", "100 %"]
    assert (drawn.x_title, drawn.second, plot.title) == ("friction", "command", "distance, m")
    for number, (name, lowest) in enumerate((("80 %", 1.0), ("100 %", 4.0)), 1):
        points = [shape for shape in of_kind(plot, f"role-series-{number}") if shape.words]
        across = [start(shape)[0] for shape in points]
        assert np.diff(across) == pytest.approx([np.diff(across)[0]] * 2, abs=0.2)
        expected = [f"{name}, {at}: {lowest + k:g}, 1 case" for k, at in enumerate(("0.08", "0.10", "0.12"))]
        assert [shape.words for shape in points] == expected
    lower, upper = (start(of_kind(plot, f"role-series-{number}")[1])[1] for number in (1, 2))
    assert lower > upper  # pixels count downwards


def test_a_cell_without_the_measure_is_a_gap():
    drawn = lines_of(axis("a", "1", "2"), axis("b", "1", "2", "3"), [[1.0, NAN, 3.0], [1.0, 2.0, 3.0]])
    (plot,) = drawn.plots
    assert [shape.path.count("M") for shape in of_kind(plot, "line")] == [2, 1]
    assert len(of_kind(plot, "point")) == 5


MANY = axis("many", *(str(k) for k in range(MOST_LINES + 1)))
NAMED = axis("adhesion", "de Pater", "other")


def test_the_parameter_with_few_values_has_the_lines_and_names_can_be_one():
    drawn = lines_of(MANY, NAMED, [[float(k), k + 1.0] for k in range(7)])
    assert (drawn.second, drawn.of_cases) == ("adhesion", "1 case")
    assert [name for _, name in drawn.key] == ["de Pater", "other"]
    # Names across, or too many values of both, have no lines.
    assert lines_of(NAMED, axis("b", "first", "second"), [[1.0, 2.0], [3.0, 4.0]]) is None
    assert lines_of(MANY, MANY, np.ones((7, 7)).tolist()) is None


def trend_of(values, means, counted=1, cases=1, met=1):
    """Return the plot of a measure that `counted` of the cases at each value have."""
    ends = {"minimum": [mean and mean - 1.0 for mean in means], "maximum": means, "mean": means}
    counted = [counted] * len(values) if isinstance(counted, int) else counted
    own = {"parameter": "speed", "measure": "distance", "unit": "m", "values": values, "cases": counted}
    counts = [OutcomeCount(of_json(SweptValue, value), cases, met, {}) for value in values]
    return trend_plot(of_json(Trend, {**own, **ends}), counts)


def test_a_trend_is_drawn_in_the_order_of_its_numbers_and_passes_over_what_has_no_figure():
    plot = trend_of(["120 km/h", "80 km/h", "90 km/h", "100 km/h"], [400.0, 200.0, None, 300.0])
    assert (plot.title, plot.x_title) == ("distance, m; n = 1", "speed, km/h")
    assert of_kind(plot, "spread") == []
    points = of_kind(plot, "point")
    assert [shape.words[:8] for shape in points] == ["80 km/h:", "100 km/h", "120 km/h"]
    xs, ys = zip(*map(start, points), strict=True)
    assert list(xs) == sorted(xs)
    assert list(ys) == sorted(ys, reverse=True)
    assert not of_kind(plot, "missed")


def test_a_value_of_several_cases_has_a_band_and_says_how_many_missed_and_how_many_are_counted():
    intervals = [{"low": low, "high": low + 0.01, "unit": ""} for low in (0.08, 0.09)]
    plot = trend_of(intervals, [2.0, 3.0], counted=4, cases=4, met=3)
    (band,) = of_kind(plot, "spread")
    assert band.path.endswith("Z")
    assert [shape.words for shape in of_kind(plot, "missed")] == [
        "0.08 .. 0.09: 2 (1 .. 2), 4 cases; 1 not met",
        "0.09 .. 0.1: 3 (2 .. 3), 4 cases; 1 not met",
    ]
    # The figure is known of three of four stops, and of one.
    plot = trend_of(["60", "80"], [2.0, 4.0], counted=[3, 1], cases=4, met=2)
    words = [shape.words for shape in of_kind(plot, "point")]
    assert words == ["60: 2 (1 .. 2), 3 cases; 2 not met", "80: 4, 1 case; 2 not met"]
    assert [label.text for label in plot.labels] == ["n = 3", "n = 1"]


@pytest.mark.parametrize(
    "values", [["full", "none"], ["80 km/h", "20 m/s"], ["80 km/h"], ["full", "3"], ["80 km/h", "80 km/h"]]
)
def test_what_has_no_common_axis_is_not_drawn(values):
    assert trend_of(values, [1.0, 2.0][: len(values)]) is None


def scan(speed, *flips, command="80 %"):
    """Return a scan along the friction at which the verdict flips between some values."""
    flips = [{"low": low, "high": high, "met_at_low": met_at_low} for low, high, met_at_low in flips]
    return {"circumstances": {"command": command, "speed": speed}, "flips": flips, "note": ""}


def frontier(*scans):
    return frontier_plot(of_json(Frontier, {"parameter": "rail.friction", "stretches": scans}))


def test_the_frontier_is_drawn_over_the_first_parameter_that_changes():
    ends = {"60 km/h": ("0.10", "0.12"), "90 km/h": ("0.12", "0.14"), "120 km/h": ("0.14", "0.16")}
    drawn = frontier(*(scan(speed, (*own, False)) for speed, own in ends.items()))
    assert drawn.plot.x_title == "speed, km/h"
    assert [name for _, name in drawn.key] == ["command = 80 %"]
    xs, ys = zip(*map(start, of_kind(drawn.plot, "point")), strict=True)
    assert list(xs) == sorted(xs)
    assert list(ys) == sorted(ys, reverse=True)


def test_a_window_has_a_line_at_each_end_and_a_gap_where_nothing_flips():
    window = ("0.1", "0.1", False), ("0.3", "0.3", True)
    flips_at = {60: window, 80: window, 100: (), 120: window, 160: ()}
    drawn = frontier(*(scan(f"{speed} km/h", *flips) for speed, flips in flips_at.items()))
    (line,) = of_kind(drawn.plot, "line")
    # At either end of the window: two neighbours joined, and one beyond the gap alone.
    assert [stroke.count("L") for stroke in line.path.split("M")[1:]] == [1, 0, 1, 0]
    points = of_kind(drawn.plot, "point")
    assert len(points) == 6
    # The axis reaches to what was scanned, also where nothing flips.
    assert drawn.plot.x_ticks[-1][1] == "160"
    assert max(start(shape)[0] for shape in points) < drawn.plot.across[1] - 100


def test_more_combinations_than_lines_are_counted_and_over_no_other_number_there_is_only_a_table():
    flip = ("0.1", "0.2", False)
    many = [scan(f"{v} km/h", flip, command=f"{c} %") for v in range(10, 90, 10) for c in (60, 90)]
    drawn = frontier(*many)
    assert (len(drawn.key), len(of_kind(drawn.plot, "line")), drawn.left_out) == (6, 6, 2)
    assert frontier(scan("b", ("1", "2", False), command="a")) is None
    assert frontier(scan("60 km/h"), scan("80 km/h")) is None
