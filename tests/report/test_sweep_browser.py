"""The page of a sweep in a browser: what is drawn and led to."""

import pytest

from uictest.report.page import sweep_page_html
from uictest.report.sweep.result import SweepContent
from uictest.report.traces.trace import trace_of

from .builders import make_recording, make_result
from .chromium import PLOTTED, click, resize, run, wait, written
from .sweep_rows import row, sweep_result, write_rows

_MAP = """
const map = document.getElementById(arguments[0]);
const empty = map.querySelector('.no-case');
return [map.checkVisibility(), [...map.querySelectorAll('tbody tr')].map((row) =>
  [...row.cells].map((cell) => cell.textContent)), getComputedStyle(empty).backgroundImage];
"""


def test_a_link_unfolds_its_map_and_a_cell_without_a_case_is_hatched(browser, tmp_path):
    """Of three parameters; there are no cases of a = 1, b = 1, and one case fails."""
    values = {key: ["0", "1"] for key in ("a", "c", "b")}
    rows = [
        row(
            f"{a}{b}{c}",
            "fail" if (a, b, c) == (0, 0, 0) else "pass",
            **{"parameters.a": str(a), "parameters.b": str(b), "parameters.c": str(c)},
        )
        for a, b, c in ((0, 0, 0), (0, 0, 1), (0, 1, 0), (0, 1, 1), (1, 0, 0), (1, 0, 1))
    ]
    write_rows(tmp_path, rows)
    path = written(tmp_path, sweep_page_html(SweepContent(tmp_path, sweep_result(values, 6), {})))
    browser.get(f"{path.as_uri()}#map-met-a-b")
    shown, table, ground = run(browser, _MAP, "map-met-a-b")
    assert shown
    assert table == [["0", "50", "100"], ["1", "100", ""]]
    assert "gradient" in ground


@pytest.fixture
def sweep_page(tmp_path, make_sweep):
    """The page of a sweep with a drawn case that was not met."""
    worst = make_result(
        id="study[a]", outcome="fail", parameters={"brake.x": "80 %", "rail.friction": "0.10"}
    )
    traces = {worst.id: trace_of(make_recording())}
    return written(tmp_path, sweep_page_html(make_sweep((worst,), "x", traces=traces)))


def test_the_worst_case_is_drawn_and_reached_from_the_map(browser, sweep_page):
    browser.get(sweep_page.as_uri())
    assert wait(browser, PLOTTED) > 15
    click(browser, ".swept-map a")
    assert browser.current_url.endswith("#case-study%5Ba%5D")


def test_it_can_be_read_without_javascript(browser, sweep_page):
    browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    browser.get(sweep_page.as_uri())
    text = browser.find_element("tag name", "body").text
    counts = "4 cases: 3 pass, 1 fail; 1 not as expected"
    for shown in (counts, "study[a]", "Measures over rail.friction", "Frontier along", "Provenance"):
        assert shown in text
    lines = browser.find_element("css selector", "section[aria-labelledby=lines-1] svg.plot")
    assert lines.size["height"] > 100


@pytest.mark.parametrize("width", [1400, 390])
def test_figures_and_frontier_are_in_sight_without_scrolling(browser, tmp_path, make_sweep, width):
    flips = [{"low": "0.10", "high": "0.12", "met_at_low": False}]
    stretches = [
        {"circumstances": {"speed": f"{speed} km/h"}, "flips": flips, "note": ""} for speed in (60, 90)
    ]
    index = {"value": 0.512, "low": 0.412, "high": 0.612}
    key = "brake.system.wsp_valve.vent_conductance"
    sensitivity = {"measure": "braking_distance_m", "circumstances": {}, "key": key}
    content = make_sweep(
        text="x",
        frontier={"parameter": "rail.friction", "stretches": stretches},
        sensitivities=[{**sensitivity, "first": index, "total": index}],
    )
    resize(browser, width)
    browser.get(written(tmp_path, sweep_page_html(content)).as_uri())
    for shown in (".indices td.number", ".worst td", "svg.frontier"):
        ends = run(
            browser,
            "return [...document.querySelectorAll(arguments[0])].map((e) => e.getBoundingClientRect().right)",
            shown,
        )
        assert ends
        assert max(ends) <= width
