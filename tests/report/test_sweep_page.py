"""The page of a sweep: what stands on it, and that nothing in it runs."""

from dataclasses import replace

import pytest
from pydantic import TypeAdapter

from uictest.report import Frontier, MeasureHistogram, OutcomeCount, Trend, WrittenValue
from uictest.report.page import sweep_page_html
from uictest.report.page.sweep.frontier_plot import frontier_plot
from uictest.report.page.sweep.histogram import histogram_plot
from uictest.report.page.sweep.trend_plot import trend_plot
from uictest.report.traces.trace import trace_of

from .builders import HOSTILE, make_recording, make_result
from .test_page import Page


def of_json(kind, form):
    """Return what stands in `sweep.json` in this form."""
    return TypeAdapter(kind).validate_python(form)


def test_every_finding_has_a_heading(make_sweep):
    text = Page(sweep_page_html(make_sweep())).text
    headings = (
        "4 cases: 3 pass, 1 fail; 1 not as expected; Cases met; Braking distance, m; Frontier along 90 %"
    )
    others = "Cases met by parameter; Measures by parameter; Distributions; What the measures depend on"
    for heading in (*headings.split("; "), *others.split("; "), "Cases most worth looking at", "Provenance"):
        assert heading in text


def test_what_was_asked_comes_before_the_maps(make_sweep):
    text = Page(sweep_page_html(make_sweep())).text
    asked = [text.index(heading) for heading in ("Frontier along", "What the measures depend on", "Maps")]
    assert asked == sorted(asked)
    assert text.index("Maps") < text.index("Distributions")


def test_where_all_cases_are_met_no_drawing_says_so_again(make_sweep):
    content = make_sweep()
    result = replace(content.result, cases=content.result.met, missed=())
    text = Page(sweep_page_html(replace(content, result=result))).text
    assert "Cases met by parameter" not in text


def test_a_worst_case_is_drawn_and_linked_from_its_row_and_its_cell(make_sweep):
    parameters = {"brake.90 %": "80 %", "rail.friction": "0.10"}
    worst = make_result(id="stop[a]", parameters=parameters)
    traces = {"stop[a]": trace_of(make_recording())}
    page = Page(sweep_page_html(make_sweep((worst,), traces=traces)))
    assert ("details", {"class": "stop", "id": "case-stop[a]"}) in page.elements
    links = [attributes.get("href") for tag, attributes in page.elements if tag == "a"]
    # From two maps and from the table of cases.
    assert links.count("#case-stop%5Ba%5D") == 3


def test_without_recordings_there_is_nothing_to_draw(make_sweep):
    page = Page(sweep_page_html(make_sweep((make_result(id="stop[a]"),))))
    assert "stop[a]" in page.text
    assert not any("var uPlot=" in text for _, text in page.scripts)


def test_hostile_texts_are_shown_and_make_no_element(make_sweep):
    harmless = Page(sweep_page_html(make_sweep((make_result(),))))
    page = Page(sweep_page_html(make_sweep((make_result(id=HOSTILE, reason=HOSTILE),), text=HOSTILE)))
    assert [tag for tag, _ in page.elements if tag == "b"] == []
    assert [tag for tag, _ in page.elements] == [tag for tag, _ in harmless.elements]
    assert "<b>&" in page.text
    assert "\u202e" not in page.text


def test_a_map_of_a_million_cells_is_bundled(make_sweep):
    values = [str(k) for k in range(1000)]
    cells = {name: [[1] * 1000] * 1000 for name in ("means", "met", "cases")}
    axes = {name: {"parameter": name, "values": values} for name in ("rows", "columns")}
    html = sweep_page_html(make_sweep(maps=[{"measure": "met", **axes, **cells}]))
    assert len(html) < 1_000_000
    assert "Folded: neighbours of 1000 values of rows share 59 cells." in html


def test_bars_stack_to_the_cases_of_their_bin():
    counts = {"pass": [3, 0], "fail": [1, 2]}
    ends = {"minimum": 0.0, "mean": 1.0, "maximum": 2.0}
    form = {"measure": "slide", "unit": "1", "cases": 6, "edges": [0.0, 1.0, 2.0], "counts": counts, **ends}
    drawn = histogram_plot(of_json(MeasureHistogram, form))
    height = {(bar.outcome, round(bar.x)): bar.height for bar in drawn.bars}
    per_case = (drawn.bottom - drawn.top) / 4
    assert sorted(height.values()) == pytest.approx([per_case, 2 * per_case, 3 * per_case])
    assert drawn.outcomes == ["pass", "fail"]


def drawn(values, means, cases=1, met=1):
    ends = {"minimum": [mean and mean - 1.0 for mean in means], "maximum": means}
    own = {"parameter": "speed", "measure": "distance", "unit": "m", "cases": [cases] * len(values)}
    counts = [OutcomeCount(WrittenValue(value), cases, met, {}) for value in values]
    return trend_plot(of_json(Trend, {**own, "values": values, "mean": means, **ends}), counts)


def test_a_trend_is_drawn_in_the_order_of_its_numbers_and_passes_over_what_has_no_figure():
    plot = drawn(["120 km/h", "80 km/h", "90 km/h", "100 km/h"], [400.0, 200.0, None, 300.0])
    assert (plot.title, plot.x_title, plot.band) == ("distance, m", "speed, km/h", "")
    assert [point.label[:8] for point in plot.points] == ["80 km/h:", "100 km/h", "120 km/h"]
    xs, ys = ([getattr(point, name) for point in plot.points] for name in ("x", "y"))
    assert xs == sorted(xs)
    assert ys == sorted(ys, reverse=True)
    assert not any(point.missed for point in plot.points)


def test_a_value_of_several_cases_has_a_band_and_says_how_many_missed():
    plot = drawn(["0.08 .. 0.09", "0.09 .. 0.1"], [2.0, 3.0], cases=4, met=3)
    assert plot.band.endswith("Z")
    assert plot.points[0].missed
    assert plot.points[0].label == "0.08 .. 0.09: 2 (1 .. 2), 4 cases; 1 not met"
    # A stretch lies at its middle, so that two of them are one step apart.
    (low, _), (high, _) = plot.x_ticks[0], plot.x_ticks[-1]
    assert low < high


def test_a_point_says_how_many_cases_its_mean_is_of():
    """Two of four stops are not met; the figure is known of three of them."""
    own = {"parameter": "speed", "measure": "distance", "unit": "m", "cases": [3, 1]}
    ends = {"minimum": [1.0, 4.0], "mean": [2.0, 4.0], "maximum": [3.0, 4.0]}
    counts = [OutcomeCount(WrittenValue("60"), 4, 2, {}), OutcomeCount(WrittenValue("80"), 4, 4, {})]
    plot = trend_plot(of_json(Trend, {**own, "values": ["60", "80"], **ends}), counts)
    assert [point.label for point in plot.points] == ["60: 2 (1 .. 3), 3 cases; 2 not met", "80: 4, 1 case"]


@pytest.mark.parametrize(
    "values", [["full", "none"], ["80 km/h", "20 m/s"], ["80 km/h"], ["full", "3"], ["80 km/h", "80 km/h"]]
)
def test_what_has_no_common_axis_is_not_drawn(values):
    assert drawn(values, [1.0, 2.0][: len(values)]) is None


def stretch(command, speed, low, high):
    flips = [{"low": low, "high": high, "met_at_low": False}]
    return {"circumstances": {"command": command, "speed": speed}, "flips": flips, "note": ""}


def frontier(*stretches):
    return frontier_plot(of_json(Frontier, {"parameter": "rail.friction", "stretches": stretches}))


def test_the_frontier_is_drawn_over_the_first_parameter_that_changes():
    ends = {"60 km/h": ("0.10", "0.12"), "90 km/h": ("0.12", "0.14"), "120 km/h": ("0.14", "0.16")}
    plot = frontier(*(stretch("80 %", speed, *own) for speed, own in ends.items()))
    assert plot.x_title == "speed, km/h"
    (series,) = plot.series
    xs, ys, _ = zip(*series.points, strict=True)
    assert series.name == "command = 80 %"
    assert list(xs) == sorted(xs)
    assert list(ys) == sorted(ys, reverse=True)


def test_a_window_has_a_line_at_each_end_and_a_gap_where_nothing_flips():
    window = [{"low": at, "high": at, "met_at_low": at == "0.3"} for at in ("0.1", "0.3")]
    flips_at = {60: window, 80: window, 100: [], 120: window, 160: []}
    plot = frontier(
        *(
            {"circumstances": {"speed": f"{speed} km/h"}, "flips": flips, "note": ""}
            for speed, flips in flips_at.items()
        )
    )
    (series,) = plot.series
    # At either end of the window: two neighbours joined, and one beyond the gap alone.
    assert [stroke.count("L") for stroke in series.path.split("M")[1:]] == [1, 0, 1, 0]
    assert len(series.points) == 6
    # The axis reaches to what was scanned, also where nothing flips.
    assert plot.x_ticks[-1][1] == "160"
    assert max(x for x, _, _ in series.points) < plot.right - 100


def test_a_frontier_over_no_other_number_is_a_table_only():
    assert frontier(stretch("a", "b", "1", "2")) is None
