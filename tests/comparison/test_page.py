"""The page of a comparison as text: what stands in it without a browser."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from uictest.analysis import comparison
from uictest.analysis.comparison.page import MEASURE, MOST, dumbbells, in_page_units, quantity_title
from uictest.analysis.comparison.paired_document import effects
from uictest.analysis.comparison.paired_stops import CONFIDENCE, PairedDifference, PairedGroup
from uictest.core.recording import Recording, parquet_bytes
from uictest.core.series_measures import Estimate
from uictest.report import Difference, StatusChange, status_difference
from uictest.report.page import forest

from .conftest import make_recording, make_run


def _compared(first, second, *tolerances):
    read = comparison.Tolerances.read(tolerances)
    return comparison.compare_recordings(first, second, ("a", "b"), read, ["*"])


def _html(first, second, *tolerances):
    return comparison.comparison_html(_compared(first, second, *tolerances))


def _cells(page, channel, table):
    """Return the texts of the cells of a channel in a table."""
    rows = page[page.index(f'class="{table}"') :].partition("</table>")[0]
    (row,) = (each for each in rows.split("<tr") if re.search(rf"[(>]{channel}[)<]", each))
    return [re.sub("<[^>]+>", "", each).strip() for each in re.findall("<td[^>]*>(.*?)</td>", row)]


def test_a_difference_is_signed_and_relative_in_the_units_of_the_page():
    first = make_recording()
    time = first["time"]
    page = _html(first, make_recording(speed=30.0 - time - np.where(np.isclose(time, 5.0), 2.0, 0.0)))
    # 25 m/s and 23 m/s; a thousandth of 10 m/s is allowed.
    expected = ["differs", "90", "82.8", "-7.2", "-8", "0.036", "km/h", "largest at 5 s"]
    assert _cells(page, "speed", "differing") == expected
    largest = ["km/h", "at 5 s", "90", "82.8", "-7.2", "-8", "0.036", f"{-7.2 / 101:+.5g}"]
    assert _cells(page, "speed", "side-values") == largest


def test_turned_verdicts_come_first_and_the_others_by_how_far_they_are_out():
    found = _compared(make_recording(), make_recording())
    near, far = (
        Difference("stop", name, 100.0, 100.0 + off, False, "m", off, 1.0)
        for name, off in (("braking_distance_m", 2.0), ("deceleration_distance_m", 9.0))
    )
    turned = status_difference("stop", StatusChange("pass", "fail"))
    page = comparison.comparison_html(replace(found, differences=(near, far, turned)))
    first = page[page.index('id="turned"') : page.index("</section>", page.index('id="turned"'))]
    assert "outcome" in first
    assert '<span class="word word-bad">new</span>' in first
    assert "B - A" not in first
    assert "distance" not in first
    rows = page[page.index('id="differences"') :]
    assert rows.index("deceleration_distance_m") < rows.index("braking_distance_m")


@pytest.mark.parametrize(
    ("quantity", "unit", "value", "shown"),
    [
        ("braking_distance_m", "m", 465.0, ("Braking distance", "m", 465.0)),
        ("maximum_clamping_force_n_3", "N", 14e3, ("Maximum clamping force of wheelset 3", "kN", 14.0)),
        ("maximum_slide_2", "1", 0.25, ("Maximum slide of wheelset 2", "%", 25.0)),
        ("valve_actuations_4", "1", 11.0, ("Valve actuations of wheelset 4", "1", 11.0)),
        ("energy_residual", "1", 1e-9, ("Energy residual", "1", 1e-9)),
        ("reservoir_minimum_bar", "bar", 7.2, ("Reservoir minimum", "bar", 7.2)),
        ("k_wet", "1", 0.87, ("k_wet", "1", 0.87)),
        ("criterion braking-distance", "", 1.0, ("criterion braking-distance", "", 1.0)),
    ],
)
def test_measures_stand_in_words_and_in_the_units_of_the_page(quantity, unit, value, shown):
    raw = Difference("slip-120", quantity, value, 2.0 * value, False, unit, value, 0.5 * value)
    found = in_page_units(raw)
    title, shown_in, number = shown
    assert (quantity_title(raw), found.unit) == (title, shown_in)
    figures = [found.first, found.second, found.deviation, found.allowed]
    assert figures == pytest.approx([number, 2.0 * number, number, 0.5 * number])


def test_recordings_that_share_no_time_have_a_page_that_says_so_and_a_state_has_no_relative_figure():
    first, late = make_recording(end=1.0), make_recording(end=1.0)
    page = _html(first, Recording({**late.channels, "time": late["time"] + 5.0}, late.units))
    assert "A and B share no time: nothing of their channels is compared." in page
    assert _cells(page, "speed", "side-values")[1] == "no common instant"
    assert "B - A: Speed, km/h" not in page
    valve = np.where(np.arange(101) > 50, 2.0, 0.0)
    page = _html(make_recording(valve_command_1=valve), make_recording(valve_command_1=0.5 * valve))
    assert _cells(page, "valve_command_1", "differing")[3:5] == ["-1", "-"]
    assert "number of the state" in page
    # Every jump leads somewhere, and ids stand once.
    ids = re.findall(r' id="([^"]+)"', page)
    assert len(ids) == len(set(ids))
    links = re.findall(r'href="#([^"]+)"', page)
    assert set(links) <= set(ids)
    assert {"differences", "case-Recordings"} <= set(links)


def test_a_stop_of_two_runs_has_a_band_only_where_a_tolerance_names_the_channel(tmp_path):
    folders = [tmp_path / name for name in ("one", "other")]
    for folder, shift in zip(folders, (0.0, 1.0), strict=True):
        (folder / "recordings").mkdir(parents=True)
        first = make_recording()
        written = parquet_bytes(make_recording(speed=first["speed"] + shift))
        (folder / "recordings" / "dry-120.parquet").write_bytes(written)
    tolerances = comparison.Tolerances.read(["5%", "speed=2"])
    compared = comparison.compare_runs(make_run(), make_run(braking_distance_m=500.0), tolerances)
    drawn = comparison.with_overlays(compared, *folders, ["speed", "slide_1"], tolerances)
    (overlay,) = drawn.overlays
    assert {each.channel: (each.allowed, each.within) for each in overlay.channels} == {
        "speed": (2.0, False),
        "slide_1": (None, None),
    }
    page = comparison.comparison_html(drawn)
    assert 'href="#case-dry-120"' in page[page.index('class="differing"') :]
    assert r"allowed \u00b12 km/h" in page
    # What a channel differs by is drawn; the runs are judged by their figures.
    assert [each.quantity for each in drawn.beyond] == ["braking_distance_m"]


def _difference(case, first, second, quantity=MEASURE):
    return Difference(case, quantity, first, second, within=False)


def test_the_case_that_differs_most_stands_first_places_are_in_proportion_and_the_others_counted():
    drawn = dumbbells([_difference("a", 400.0, 410.0), _difference("b", 500.0, 460.0)])
    assert [name for _, name in drawn.plot.y_ticks] == ["b", "a"]
    lines = [shape for shape in drawn.plot.shapes if shape.kind == "interval-line"]
    of_b, of_a = (float(each.path.split("H")[1]) - float(each.path[1:].split()[0]) for each in lines)
    assert of_b == pytest.approx(-4.0 * of_a, abs=0.5)
    assert lines[0].words == "b: 500 m, then 460 m (-40 m)"
    assert drawn.left_out == 0
    assert len(dumbbells([_difference("x" * 80, 1.0, 2.0)]).plot.y_ticks[0][1]) == 40
    drawn = dumbbells([_difference(str(k), 400.0, 401.0 + k) for k in range(MOST + 5)])
    assert (len(drawn.plot.y_ticks), drawn.left_out) == (MOST, 5)
    assert drawn.plot.y_ticks[0][1] == str(MOST + 4)
    # What is no distance of both sides has no row.
    other = _difference("a", 1.0, 2.0, quantity="braking_time_s")
    assert dumbbells([other, _difference("b", "missing", 400.0), _difference("c", float("nan"), 1.0)]) is None


def _paired(quantity, mean, half, first=100.0):
    estimate = Estimate(mean, mean - half, mean + half, CONFIDENCE, "mean", 6, mean, mean, math.nan)
    return PairedDifference(quantity, "m", first, first + mean, estimate, estimate, 6, 0, 0)


def _drawn(*differences):
    group = PairedGroup("stop", (0, 1, 2, 3, 4, 5), 6, 6, (0, 0), differences)
    return forest(effects(group), "effects", "%")


def test_the_largest_effect_stands_first_and_a_dot_is_filled_where_the_interval_leaves_out_zero():
    drawn = _drawn(*(_paired(*effect) for effect in (("a", 1.0, 0.5), ("b", -8.0, 1.0), ("c", 3.0, 3.5))))
    assert [name for _, name in drawn.y_ticks] == ["b", "c", "a"]
    heights = [y for y, _ in drawn.y_ticks]
    assert heights == sorted(heights)
    filled = [shape.words[0] for shape in drawn.shapes if shape.kind == "effect clear"]
    assert filled == ["b", "a"]
    # A mean beyond the axis is written out; what has no share or no interval is left to the table.
    drawn = _drawn(_paired("a", 900.0, 1.0), _paired("b", 3.0, 1.0))
    assert drawn.y_ticks[0][1] == "a, +900 %"
    assert _drawn(_paired("a", 1.0, 0.5, first=0.0), _paired("c", 1.0, math.nan)) is None


def test_effects_lie_in_proportion_to_the_share_of_the_first_side():
    drawn = _drawn(_paired("a", 4.0, 2.0), _paired("b", 4.0, 2.0, first=200.0))
    zero, effects_at, lows_at = (
        [float(shape.path[1:].split()[0]) for shape in drawn.shapes if shape.kind.startswith(kind)]
        for kind in ("zero", "effect", "interval-line")
    )
    means = [x + 4.0 - zero[0] for x in effects_at]  # from the middle of the circles
    lows = [x - zero[0] for x in lows_at]
    assert means == pytest.approx([2 * means[1], means[1]], abs=0.2)
    assert lows == pytest.approx([0.5 * means[0], 0.5 * means[1]], abs=0.2)
