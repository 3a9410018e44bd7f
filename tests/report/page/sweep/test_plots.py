"""The plots of a sweep: every line and band lies where its numbers are, and says them."""

import re

import numpy as np
import pytest
from pydantic import TypeAdapter

from uictest.report import (
    Frontier,
    OutcomeCount,
    Trend,
    WrittenValue,
)
from uictest.report.page.sweep.line_plots import MOST_LINES, cell_lines, frontier_plot, trend_plot
from uictest.report.sweep.map_cells import CellAxis, MapCells

NAN = float("nan")


def of_json(kind, form):
    """Return what stands in `sweep.json` in this form."""
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


def test_the_parameter_with_few_values_has_the_lines_and_names_can_be_one():
    many = axis("many", *(str(k) for k in range(MOST_LINES + 1)))
    drawn = lines_of(many, axis("adhesion", "de Pater", "other"), [[float(k), k + 1.0] for k in range(7)])
    assert (drawn.second, drawn.of_cases) == ("adhesion", "1 case")
    assert [name for _, name in drawn.key] == ["de Pater", "other"]


def test_names_across_and_too_many_values_of_both_have_no_lines():
    named = axis("a", "de Pater", "other")
    assert lines_of(named, axis("b", "first", "second"), [[1.0, 2.0], [3.0, 4.0]]) is None
    many = [str(k) for k in range(MOST_LINES + 1)]
    assert lines_of(axis("a", *many), axis("b", *many), np.ones((7, 7)).tolist()) is None


def trend_of(values, means, cases=1, met=1):
    ends = {"minimum": [mean and mean - 1.0 for mean in means], "maximum": means}
    own = {"parameter": "speed", "measure": "distance", "unit": "m", "cases": [cases] * len(values)}
    counts = [OutcomeCount(WrittenValue(value), cases, met, {}) for value in values]
    return trend_plot(of_json(Trend, {**own, "values": values, "mean": means, **ends}), counts)


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


def test_a_value_of_several_cases_has_a_band_and_says_how_many_missed():
    plot = trend_of(["0.08 .. 0.09", "0.09 .. 0.1"], [2.0, 3.0], cases=4, met=3)
    (band,) = of_kind(plot, "spread")
    assert band.path.endswith("Z")
    assert [shape.words for shape in of_kind(plot, "missed")] == [
        "0.08 .. 0.09: 2 (1 .. 2), 4 cases; 1 not met",
        "0.09 .. 0.1: 3 (2 .. 3), 4 cases; 1 not met",
    ]


def test_a_point_says_how_many_cases_its_mean_is_of():
    """Two of four stops are not met; the figure is known of three of them."""
    own = {"parameter": "speed", "measure": "distance", "unit": "m", "cases": [3, 1]}
    ends = {"minimum": [1.0, 4.0], "mean": [2.0, 4.0], "maximum": [3.0, 4.0]}
    counts = [OutcomeCount(WrittenValue("60"), 4, 2, {}), OutcomeCount(WrittenValue("80"), 4, 4, {})]
    plot = trend_plot(of_json(Trend, {**own, "values": ["60", "80"], **ends}), counts)
    words = [shape.words for shape in of_kind(plot, "point")]
    assert words == ["60: 2 (1 .. 3), 3 cases; 2 not met", "80: 4, 1 case"]
    assert [label.text for label in plot.labels] == ["n = 3", "n = 1"]


@pytest.mark.parametrize(
    "values", [["full", "none"], ["80 km/h", "20 m/s"], ["80 km/h"], ["full", "3"], ["80 km/h", "80 km/h"]]
)
def test_what_has_no_common_axis_is_not_drawn(values):
    assert trend_of(values, [1.0, 2.0][: len(values)]) is None


def scan(command, speed, low, high):
    flips = [{"low": low, "high": high, "met_at_low": False}]
    return {"circumstances": {"command": command, "speed": speed}, "flips": flips, "note": ""}


def frontier(*scans):
    return frontier_plot(of_json(Frontier, {"parameter": "rail.friction", "stretches": scans}))


def test_the_frontier_is_drawn_over_the_first_parameter_that_changes():
    ends = {"60 km/h": ("0.10", "0.12"), "90 km/h": ("0.12", "0.14"), "120 km/h": ("0.14", "0.16")}
    drawn = frontier(*(scan("80 %", speed, *own) for speed, own in ends.items()))
    assert drawn.plot.x_title == "speed, km/h"
    assert [name for _, name in drawn.key] == ["command = 80 %"]
    xs, ys = zip(*map(start, of_kind(drawn.plot, "point")), strict=True)
    assert list(xs) == sorted(xs)
    assert list(ys) == sorted(ys, reverse=True)


def test_a_window_has_a_line_at_each_end_and_a_gap_where_nothing_flips():
    window = [{"low": at, "high": at, "met_at_low": at == "0.3"} for at in ("0.1", "0.3")]
    flips_at = {60: window, 80: window, 100: [], 120: window, 160: []}
    drawn = frontier(
        *(
            {"circumstances": {"speed": f"{speed} km/h"}, "flips": flips, "note": ""}
            for speed, flips in flips_at.items()
        )
    )
    (line,) = of_kind(drawn.plot, "line")
    # At either end of the window: two neighbours joined, and one beyond the gap alone.
    assert [stroke.count("L") for stroke in line.path.split("M")[1:]] == [1, 0, 1, 0]
    points = of_kind(drawn.plot, "point")
    assert len(points) == 6
    # The axis reaches to what was scanned, also where nothing flips.
    assert drawn.plot.x_ticks[-1][1] == "160"
    assert max(start(shape)[0] for shape in points) < drawn.plot.across[1] - 100


def test_a_frontier_over_no_other_number_is_a_table_only():
    assert frontier(scan("a", "b", "1", "2")) is None
