"""Axes, colours, and the plots of a sweep: every line and band lies where its numbers are, and says them."""

import itertools
import re
from importlib import resources

import numpy as np
import pytest
from hypothesis import given, strategies as st
from pydantic import TypeAdapter

from uictest.report import Frontier, OutcomeCount, SweptValue, Trend, WrittenValue
from uictest.report.page.plot import Axis, Effect, forest, round_step, span, spanned
from uictest.report.page.sweep_lines import MOST_LINES, cell_lines, frontier_plot, trend_plot
from uictest.report.sweep.sweep_maps import CellAxis, MapCells


@given(st.floats(1e-9, 1e9))
def test_a_step_is_round_and_not_below_what_was_asked(step):
    found = round_step(step)
    assert step * (1 - 1e-6) <= found <= 2.5 * step * (1 + 1e-6)
    assert f"{found:.0e}"[0] in "125"


@given(st.floats(-1e6, 1e6), st.floats(1e-3, 1e6), st.integers(2, 12))
def test_ticks_lie_on_the_axis_and_are_few(low, extent, most):
    axis = Axis(low, low + extent, 0.0, 100.0)
    ticks = axis.ticks(most)
    assert len(ticks) <= most + 1
    assert all(low - 1e-6 * extent <= at <= low + extent * (1 + 1e-6) for at, _ in ticks)


def test_labels_have_the_decimals_of_the_step_and_what_lies_outside_is_drawn_at_the_edge():
    labels = [label for _, label in Axis(0.0, 0.1, 0.0, 1.0).ticks(5)]
    assert labels == ["0.00", "0.02", "0.04", "0.06", "0.08", "0.10"]
    axis = Axis(0.0, 10.0, 100.0, 0.0)
    assert (axis.at(-5.0), axis.at(2.5), axis.at(99.0)) == (100.0, 75.0, 0.0)


@pytest.mark.parametrize(
    ("values", "include", "expected"),
    [
        ([], [], (0.0, 1.04)),
        ([np.nan], [0.0], (0.0, 1.0)),
        ([3.0, 3.0], [], (3.0, 4.0)),
        ([0.0, 10.0], [0.0], (0.0, 10.4)),
        ([-10.0, 0.0, np.inf], [], (-10.4, 0.4)),
    ],
)
def test_the_span_holds_everything_finite(values, include, expected):
    assert span([np.array(values)], include) == pytest.approx(expected)


def test_equal_ratios_are_equally_long_on_a_logarithmic_axis():
    axis = Axis(0.1, 1000.0, 0.0, 400.0, logarithmic=True)
    places = [axis.at(value) for value in (0.1, 1.0, 10.0, 100.0, 1000.0)]
    assert places == pytest.approx([0, 100, 200, 300, 400])
    assert axis.pixels(np.array([0.1, 10.0, np.nan])).tolist() == pytest.approx([0, 200, np.nan], nan_ok=True)
    assert [label for _, label in axis.tick_marks(6)] == ["0.1", "1", "10", "100", "1000"]


@pytest.mark.parametrize(
    ("low", "high", "logarithmic", "most", "labels"),
    [
        # Decades have ones, twos and fives where there is room; less than a decade has even steps.
        (8e-9, 6e-7, True, 8, "1e-08 2e-08 5e-08 1e-07 2e-07 5e-07"),
        (2e-8, 3.9e-8, True, 5, "2e-08 2.5e-08 3e-08 3.5e-08"),
        (32000.0, 32010.0, False, 7, "32000 32002 32004 32006 32008 32010"),
        (1.0, 4294967295.0, False, 4, "0 2000000000 4000000000"),
    ],
)
def test_ticks_are_round_and_have_labels_of_their_own(low, high, logarithmic, most, labels):
    axis = Axis(low, high, 0.0, 100.0, logarithmic=logarithmic)
    found = [label for _, label in axis.tick_marks(most)]
    assert found == labels.split()


@given(st.floats(1e-9, 1e9), st.floats(1.01, 1e12), st.booleans())
def test_ticks_lie_on_the_axis_where_their_numbers_do(low, ratio, logarithmic):
    axis = Axis(low, low * ratio, 0.0, 100.0, logarithmic)
    ticks = axis.tick_marks(7)
    assert 1 <= len(ticks) <= 9
    assert [at for at, _ in ticks] == sorted(at for at, _ in ticks)
    for at, label in ticks:
        assert at == pytest.approx(axis.at(float(label)), abs=0.5)


def test_an_axis_with_a_number_that_has_no_logarithm_is_linear():
    assert not spanned([0.0, 1.0], 0.0, 1.0, logarithmic=True).logarithmic
    axis = spanned([1.0, 100.0, float("nan")], 0.0, 1.0, logarithmic=True)
    assert axis.logarithmic
    assert 0.0 < axis.at(1.0) < 0.1


# Machado, Oliveira and Fernandes, IEEE Trans. Visualization and Computer Graphics 15 (2009), severity 1.
VISION = {
    "ordinary": [1, 0, 0, 0, 1, 0, 0, 0, 1],
    "protan": [0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998],
    "deutan": [0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881],
    "tritan": [1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900],
}  # fmt: skip
_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
_WHITE = np.array([0.95047, 1.0, 1.08883])


def _linear(text):
    channels = np.array([int(text[k : k + 2], 16) for k in (1, 3, 5)]) / 255
    return np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)


def _lab(colour):
    x, y, z = (
        np.cbrt(each) if each > 0.008856 else 7.787 * each + 16 / 116 for each in _XYZ @ colour / _WHITE
    )
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def _distance(first, second, vision):
    matrix = np.reshape(vision, (3, 3))
    seen = (_lab(np.clip(matrix @ _linear(each), 0, 1)) for each in (first, second))
    return float(np.linalg.norm(next(seen) - next(seen)))


def _contrast(first, second):
    dark, light = sorted(float(_XYZ[1] @ _linear(each)) for each in (first, second))
    return (light + 0.05) / (dark + 0.05)


def _palette(name, theme):
    style = (resources.files("uictest.report.page") / "styles" / "base.css").read_text("utf-8")
    pairs = re.findall(rf"--{name}(?:-\d)?: light-dark\((#\w{{6}}), (#\w{{6}})\)", style)
    return [pair[theme] for pair in pairs]


@pytest.mark.parametrize("vision", VISION)
@pytest.mark.parametrize("theme", [0, 1])
def test_wheelsets_and_compared_cases_with_the_same_line_style_are_told_apart_by_their_colours(theme, vision):
    """15 is more than six times what is just seen in CIELAB, 2.3."""
    wheelsets, compared = _palette("wheelset", theme), _palette("compared", theme)
    assert (len(wheelsets), len(compared)) == (4, 8)
    for first, second in [*itertools.combinations(wheelsets, 2), *itertools.combinations(compared[:4], 2)]:
        assert _distance(first, second, VISION[vision]) > 15.0, (first, second)
    for first, second in zip(compared[:4], compared[4:], strict=True):
        assert _distance(first, second, VISION[vision]) > 20.0, (first, second)


@pytest.mark.parametrize("theme", [0, 1])
def test_lines_stand_out_from_the_ground(theme):
    """WCAG 2.1, 1.4.11: 3 to 1 for graphical objects."""
    (paper,) = _palette("paper", theme)
    for colour in [*_palette("wheelset", theme), *_palette("compared", theme)]:
        assert _contrast(colour, paper) >= 3.0, colour


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
    cells = MapCells(rows, columns, counts, counts, counts, {}, {"distance": np.array(means)})
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
    assert of_kind(plot, "spread") == of_kind(plot, "missed") == []
    points = of_kind(plot, "point")
    assert [shape.words[:8] for shape in points] == ["80 km/h:", "100 km/h", "120 km/h"]
    xs, ys = zip(*map(start, points), strict=True)
    assert list(xs) == sorted(xs)
    assert list(ys) == sorted(ys, reverse=True)
    # What has no common axis is not drawn.
    for values in (["full", "none"], ["80 km/h", "20 m/s"], ["80 km/h"], ["full", "3"], ["80 km/h"] * 2):
        assert trend_of(values, [1.0, 2.0][: len(values)]) is None


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


def test_a_mean_is_filled_where_its_interval_leaves_out_zero():
    effects = [Effect("a", 3.0, 2.0, 4.0), Effect("b", 2.0, -0.5, 4.5), Effect("c", -1.0, -1.5, -0.5)]
    shapes = forest(effects, "", "").shapes
    assert [shape.words[0] for shape in shapes if shape.kind == "effect clear"] == ["a", "c"]
