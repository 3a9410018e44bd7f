"""Two recordings over each other and their difference beneath, in a browser."""

import numpy as np
import pytest

from uictest.analysis import comparison
from uictest.core.recording import Recording

from .builders import make_recording
from .chromium import READY, by_head, choose, run, saved, step_to, texts, wait, written

NOTHING = "\N{EN DASH}"


@pytest.fixture(scope="module")
def laid_over_page(tmp_path_factory):
    """The stop of the fixture, and one 9 km/h faster that is recorded at half the rate, to 30 s."""
    first, whole = make_recording(), make_recording(1701)
    second = Recording({name: each[:1501] for name, each in whole.channels.items()}, whole.units)
    second["speed"][:] += 2.5
    second["distance"][:] += 2.5 * second["time"]
    tolerances = comparison.Tolerances.read(["speed=10", "1%"])
    chosen = ["speed", "slide_1", "valve_command_1"]
    compared = comparison.compare_recordings(first, second, ("one", "other"), tolerances, chosen)
    return written(tmp_path_factory.mktemp("page"), comparison.comparison_html(compared))


@pytest.fixture
def overlay(browser, laid_over_page):
    """The browser, in which the plots of both answer."""
    browser.get(laid_over_page.as_uri() + "#case-Recordings")
    wait(browser, READY)
    return browser


def _at_cursor(browser):
    """Return the cells at the cursor by channel: unit, A, B, B - A, per cent of A."""
    return by_head(browser, ".at-cursor tbody tr")


def test_the_difference_stands_beneath_each_channel_on_its_axis_and_on_paper_a_drawing_that_fits(overlay):
    traces = run(
        overlay,
        "return document.querySelector('.panels-plot').plots"
        ".map(({lines}) => lines.map((each) => [each.label, String(each.dash)]))",
    )
    names = [[name for name, _ in own] for own in traces]
    assert names == [["A", "B"], ["B - A"]] * 3 + [[]]  # the last is the axis
    (_, first), (_, second) = traces[0]
    assert first != second
    marks = run(
        overlay, "return document.querySelector('.panels-plot').plots[1].marks.map((m) => [m.kind, m.y])"
    )
    assert marks == [["tolerance", 10], ["point", pytest.approx(9.0, abs=1e-3)]]
    heights = run(
        overlay,
        "return [...document.querySelectorAll('.laid-over svg.panels')]"
        ".map((each) => each.viewBox.baseVal.height)",
    )
    assert len(heights) == 3
    # Of 960 across: less than a third of a page of A4.
    assert max(heights) < 960 * 267 / 182 / 3


def test_one_cursor_reads_both_sides_their_difference_and_its_share(overlay):
    slider = overlay.find_element("css selector", ".laid-over input[type=range]")
    step_to(overlay, slider, 500)  # the middle: 17 s
    assert overlay.find_element("css selector", ".slider output").text == "17.00 s"
    speed = 120 - 17 * 3.6
    assert _at_cursor(overlay) == {
        "Speed": ["km/h", f"{speed:.2f}", f"{speed + 9:.2f}", "9.00", f"{100 * 9 / speed:.3g}"],
        "Slide of wheelset 1": ["%", "0.000", "0.000", "0.000", NOTHING],
        "Valve command of wheelset 1": ["1", "0.0000", "0.0000", "0.0000", NOTHING],
    }
    # Behind its end, at 34 s, a side has no value.
    slider.send_keys("\ue010")
    assert _at_cursor(overlay)["Speed"] == ["km/h", "0.00", NOTHING, NOTHING, NOTHING]
    # A largest difference leads to its instant.
    run(overlay, "[...document.querySelectorAll('.laid-over .moment')].at(-1).click()")
    found = wait(overlay, "return document.querySelector('.slider output').textContent")
    button = texts(overlay, ".laid-over .moment")[-1]
    assert button.removeprefix("at ") in (found, found.replace(".00", ""))


def test_over_distance_both_sides_stand_at_the_same_place(overlay):
    choose(overlay, "across", "distance")
    title = "return document.querySelector('.panels-plot').plots.at(-1).plot.axes[0].label"
    assert wait(overlay, f"{title}.startsWith('distance') && ({title[7:]})").endswith("m")
    slider = overlay.find_element("css selector", ".laid-over input[type=range]")
    step_to(overlay, slider, 300)
    place = float(overlay.find_element("css selector", ".slider output").text.removesuffix(" m"))
    # v2 = v0**2 - 2 a s on the first side; its distance is a sum of samples, to some metres.
    a, b = (float(cell) for cell in _at_cursor(overlay)["Speed"][1:3])
    assert a == pytest.approx(3.6 * np.sqrt((120 / 3.6) ** 2 - 2.0 * place), rel=0.01)
    assert b > a


def test_the_points_of_a_channel_and_its_difference_come_as_csv(overlay):
    comments, rows = saved(overlay, ".laid-over .tables button")
    assert "Sampled every 10 ms in A and every 20 ms in B." in comments[1]
    by_line = {}
    for row in (each for each in rows if each["channel"] == "speed"):
        assert row["unit"] == "km/h"
        by_line.setdefault(row["line"], {})[float(row["time_s"])] = float(row["value"])
    assert list(by_line) == ["A", "B", "B - A"]
    for time, apart in by_line["B - A"].items():
        assert apart == pytest.approx(9.0, abs=0.01)
        assert by_line["B"][time] == pytest.approx(max(120 - 3.6 * time, 0.0) + 9.0, abs=0.01)
