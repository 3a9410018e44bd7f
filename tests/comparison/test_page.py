"""The page of a comparison as text: what stands in it without a browser."""

import re
from dataclasses import replace

import numpy as np
import pytest

from uictest.analysis import comparison
from uictest.analysis.comparison.page import conditions_plot
from uictest.analysis.comparison.runs import compare_runs
from uictest.core.recording import Recording, parquet_bytes
from uictest.report import Difference, RunContent
from uictest.report.difference import in_page_units, quantity_title
from uictest.report.page import Effect, forest

from .conftest import make_recording, make_repeated, make_run


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


def test_the_page_answers_first_and_then_lists_quantities_by_how_far_they_are_out():
    found = compare_runs(make_run(), make_run(braking_distance_m=400.0), comparison.Tolerances())
    near, far = (
        Difference("dry-120", name, 100.0, 100.0 + off, False, "m", off, 1.0)
        for name, off in (("braking_distance_m", 2.0), ("deceleration_distance_m", 9.0))
    )
    page = comparison.comparison_html(replace(found, differences=(near, far)))
    head, _, rest = page.partition("</header>")
    assert "braking distance 65 m shorter" in head
    assert '<span class="word word-good">better</span>' in rest
    rows = rest[rest.index('id="differences-1"') :]
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
    assert "case-Recordings" in ids


def test_a_stop_of_two_runs_has_a_band_only_where_a_tolerance_names_the_channel(tmp_path):
    folders = [tmp_path / name for name in ("one", "other")]
    for folder, shift in zip(folders, (0.0, 1.0), strict=True):
        (folder / "recordings").mkdir(parents=True)
        first = make_recording()
        written = parquet_bytes(make_recording(speed=first["speed"] + shift))
        (folder / "recordings" / "dry-120.parquet").write_bytes(written)
    tolerances = comparison.Tolerances.read(["5%", "speed=2"])
    compared = compare_runs(make_run(), make_run(braking_distance_m=500.0), tolerances)
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


def _answer(*changes):
    """The answer on repeated cases whose braking distance of 500 m changes by a mean and a scatter (m)."""
    sides = [[], []]
    for n, (mean, scatter) in enumerate(changes):
        for side, shifts in zip(sides, ((0.0,) * 3, (mean - scatter, mean, mean + scatter)), strict=True):
            distances = {seed: 500.0 + shift for seed, shift in enumerate(shifts)}
            side.append(make_repeated(distances, f"stop-{n}"))
    runs = [RunContent(name, cases) for name, cases in zip(("one", "other"), sides, strict=True)]
    return compare_runs(*runs, comparison.Tolerances()).answer


def test_the_largest_effect_stands_first_and_a_dot_tells_better_from_worse():
    drawn = conditions_plot(_answer((5.0, 0.5), (-40.0, 1.0), (15.0, 30.0)))
    assert [name for _, name in drawn.y_ticks] == ["stop-1: -40 m", "stop-2: +15 m", "stop-0: +5 m"]
    heights = [y for y, _ in drawn.y_ticks]
    assert heights == sorted(heights)
    dots = [shape.kind for shape in drawn.shapes if shape.kind.startswith("effect")]
    assert dots == ["effect good", "effect", "effect bad"]
    # A mean beyond the axis is written out; nothing is drawn where nothing has a number.
    drawn = forest([Effect("a", 900.0, 899.0, 901.0), Effect("b", 3.0, 2.0, 4.0)], "effects", "%")
    assert drawn.y_ticks[0][1] == "a, +900 %"
    assert conditions_plot(_answer()) is None


def test_effects_lie_in_proportion_to_the_share_of_the_first_side():
    drawn = conditions_plot(_answer((20.0, 4.0), (10.0, 2.0)))
    zero, effects_at, lows_at = (
        [float(shape.path[1:].split()[0]) for shape in drawn.shapes if shape.kind.startswith(kind)]
        for kind in ("zero", "effect", "interval-line")
    )
    means = [x + 4.0 - zero[0] for x in effects_at]  # from the middle of the circles
    lows = [x - zero[0] for x in lows_at]
    assert means == pytest.approx([2 * means[1], means[1]], abs=0.2)
    assert lows == pytest.approx([2 * lows[1], lows[1]], abs=0.2)
