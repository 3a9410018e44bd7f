"""Two recordings over each other and their difference beneath, in a browser."""

import csv

import numpy as np
import pytest

from uictest.analysis import comparison
from uictest.core.recording import Recording

from .builders import make_recording
from .chromium import resize, run, step_to, wait

NOTHING = "\N{EN DASH}"
READY = "return document.querySelector('.laid-over[data-ready]') !== null"


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
    page = tmp_path_factory.mktemp("page") / "comparison.html"
    page.write_text(comparison.comparison_html(compared), encoding="utf-8")
    return page


def _open(browser, page, width=1400):
    resize(browser, width)
    browser.get(page.as_uri() + "#case-Recordings")
    wait(browser, READY)


def _at_cursor(browser):
    """Return the cells at the cursor by channel: unit, A, B, B - A, per cent of A."""
    return run(
        browser,
        "return Object.fromEntries([...document.querySelectorAll('.at-cursor tbody tr')].map((row) =>"
        " [row.cells[0].textContent, [...row.cells].slice(1).map((cell) => cell.textContent)]))",
    )


def test_the_difference_stands_beneath_each_channel_on_its_axis(browser, laid_over_page):
    _open(browser, laid_over_page)
    traces = run(
        browser,
        "return document.querySelector('.panels-plot').plots"
        ".map(({lines}) => lines.map((each) => [each.label, String(each.dash)]))",
    )
    names = [[name for name, _ in own] for own in traces]
    assert names == [["A", "B"], ["B - A"]] * 3 + [[]]  # the last is the axis
    (_, first), (_, second) = traces[0]
    assert first != second
    marks = run(
        browser, "return document.querySelector('.panels-plot').plots[1].marks.map((m) => [m.kind, m.y])"
    )
    assert marks == [["tolerance", 10], ["point", pytest.approx(9.0, abs=1e-3)]]


def test_one_cursor_reads_both_sides_their_difference_and_its_share(browser, laid_over_page):
    _open(browser, laid_over_page)
    slider = browser.find_element("css selector", ".laid-over input[type=range]")
    step_to(browser, slider, 500)  # the middle: 17 s
    assert browser.find_element("css selector", ".slider output").text == "17.00 s"
    speed = 120 - 17 * 3.6
    assert _at_cursor(browser) == {
        "Speed": ["km/h", f"{speed:.2f}", f"{speed + 9:.2f}", "9.00", f"{100 * 9 / speed:.3g}"],
        "Slide of wheelset 1": ["%", "0.000", "0.000", "0.000", NOTHING],
        "Valve command of wheelset 1": ["1", "0.0000", "0.0000", "0.0000", NOTHING],
    }


def test_behind_its_end_a_side_has_no_value(browser, laid_over_page):
    _open(browser, laid_over_page)
    browser.find_element("css selector", ".laid-over input[type=range]").send_keys("\ue010")  # end: 34 s
    assert _at_cursor(browser)["Speed"] == ["km/h", "0.00", NOTHING, NOTHING, NOTHING]


def test_over_distance_both_sides_stand_at_the_same_place(browser, laid_over_page):
    _open(browser, laid_over_page)
    run(
        browser,
        "const choice = document.querySelector('[data-choice=across]'); choice.value = 'distance';"
        "choice.dispatchEvent(new Event('change'))",
    )
    title = "return document.querySelector('.panels-plot').plots.at(-1).plot.axes[0].label"
    assert wait(browser, f"{title}.startsWith('distance') && ({title[7:]})").endswith("m")
    slider = browser.find_element("css selector", ".laid-over input[type=range]")
    step_to(browser, slider, 300)
    place = float(browser.find_element("css selector", ".slider output").text.removesuffix(" m"))
    # v2 = v0**2 - 2 a s on the first side; its distance is a sum of samples, to some metres.
    a, b = (float(cell) for cell in _at_cursor(browser)["Speed"][1:3])
    assert a == pytest.approx(3.6 * np.sqrt((120 / 3.6) ** 2 - 2.0 * place), rel=0.01)
    assert b > a


def test_a_largest_difference_leads_to_its_instant(browser, laid_over_page):
    _open(browser, laid_over_page)
    run(browser, "[...document.querySelectorAll('.laid-over .moment')].at(-1).click()")
    found = wait(browser, "return document.querySelector('.slider output').textContent")
    button = run(browser, "return [...document.querySelectorAll('.laid-over .moment')].at(-1).textContent")
    assert button.removeprefix("at ") in (found, found.replace(".00", ""))


def test_the_points_of_a_channel_and_its_difference_come_as_csv(browser, laid_over_page):
    _open(browser, laid_over_page)
    run(
        browser,
        "URL.createObjectURL = (blob) => {blob.text().then((text) => {window.saved = text;}); return '#';};"
        "document.querySelector('.laid-over .tables button').click()",
    )
    text = wait(browser, "return window.saved")
    assert "Sampled every 10 ms in A and every 20 ms in B." in text.splitlines()[1]
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    by_line = {}
    for row in (each for each in rows if each["channel"] == "speed"):
        assert row["unit"] == "km/h"
        by_line.setdefault(row["line"], {})[float(row["time_s"])] = float(row["value"])
    assert list(by_line) == ["A", "B", "B - A"]
    for time, apart in by_line["B - A"].items():
        assert apart == pytest.approx(9.0, abs=0.01)
        assert by_line["B"][time] == pytest.approx(max(120 - 3.6 * time, 0.0) + 9.0, abs=0.01)


def test_on_paper_each_channel_is_a_drawing_that_fits(browser, laid_over_page):
    browser.get(laid_over_page.as_uri())
    names = run(
        browser,
        "return [...document.querySelectorAll('.laid-over svg.panels')]"
        ".map((each) => each.viewBox.baseVal.height)",
    )
    assert len(names) == 3
    # Of 960 across: less than a third of a page of A4.
    assert max(names) < 960 * 267 / 182 / 3
