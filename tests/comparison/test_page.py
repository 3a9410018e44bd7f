"""The page of a comparison as text: what stands in it without a browser."""

import re
from dataclasses import replace

import numpy as np
import pytest

from uictest.analysis import comparison
from uictest.analysis.comparison.page import in_page_units, quantity_title
from uictest.core.recording import Recording, parquet_bytes
from uictest.report import Difference


def _html(first, second, *tolerances):
    found = comparison.compare_recordings(
        first, second, ("a", "b"), comparison.Tolerances.read(tolerances), ["*"]
    )
    return comparison.comparison_html(found)


def _cells(page, channel, table):
    """Return the texts of the cells of a channel in a table."""
    rows = page[page.index(f'class="{table}"') :].partition("</table>")[0]
    (row,) = (each for each in rows.split("<tr") if re.search(rf"[(>]{channel}[)<]", each))
    return [re.sub("<[^>]+>", "", each).strip() for each in re.findall("<td[^>]*>(.*?)</td>", row)]


def test_a_difference_is_signed_and_relative_in_the_units_of_the_page(make_recording):
    first = make_recording()
    time = first["time"]
    page = _html(first, make_recording(speed=30.0 - time - np.where(np.isclose(time, 5.0), 2.0, 0.0)))
    # 25 m/s and 23 m/s; a thousandth of 10 m/s is allowed.
    expected = ["differs", "90", "82.8", "-7.2", "-8", "0.036", "km/h", "largest at 5 s"]
    assert _cells(page, "speed", "differing") == expected
    largest = ["km/h", "at 5 s", "90", "82.8", "-7.2", "-8", "0.036", f"{-7.2 / 101:+.5g}"]
    assert _cells(page, "speed", "side-values") == largest


def test_turned_verdicts_come_first_and_the_others_by_how_far_they_are_out(make_recording):
    found = comparison.compare_recordings(
        make_recording(), make_recording(), ("a", "b"), comparison.Tolerances.read(()), ["*"]
    )
    near, far = (
        Difference("stop", name, 100.0, 100.0 + off, False, "m", off, 1.0)
        for name, off in (("braking_distance_m", 2.0), ("deceleration_distance_m", 9.0))
    )
    turned = Difference("stop", "outcome", "pass", "fail", False)
    page = comparison.comparison_html(replace(found, differences=(near, far, turned)))
    first = page[page.index('id="turned"') : page.index("</section>", page.index('id="turned"'))]
    assert "outcome" in first
    assert '<span class="word word-bad">new</span>' in first
    assert "B - A" not in first
    assert "distance" not in first
    rows = page[page.index('id="differences"') :]
    assert rows.index("deceleration_distance_m") < rows.index("braking_distance_m")


def test_a_state_has_no_relative_figure(make_recording):
    valve = np.where(np.arange(101) > 50, 2.0, 0.0)
    page = _html(make_recording(valve_command_1=valve), make_recording(valve_command_1=0.5 * valve))
    assert _cells(page, "valve_command_1", "differing")[3:5] == ["-1", "-"]
    assert "number of the state" in page


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


def test_recordings_that_share_no_time_have_a_page_that_says_so(make_recording):
    first, late = make_recording(end=1.0), make_recording(end=1.0)
    page = _html(first, Recording({**late.channels, "time": late["time"] + 5.0}, late.units))
    assert "A and B share no time: nothing of their channels is compared." in page
    assert _cells(page, "speed", "side-values")[1] == "no common instant"
    assert "B - A: Speed, km/h" not in page


def test_every_jump_leads_somewhere_and_ids_stand_once(make_recording):
    page = _html(make_recording(), make_recording(speed=np.zeros(101)))
    ids = re.findall(r' id="([^"]+)"', page)
    assert len(ids) == len(set(ids))
    links = re.findall(r'href="#([^"]+)"', page)
    assert set(links) <= set(ids)
    assert {"differences", "case-Recordings"} <= set(links)


def test_a_stop_of_two_runs_has_a_band_only_where_a_tolerance_names_the_channel(
    make_run, make_recording, tmp_path
):
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
