"""Maps and points of a sweep in a browser: what is drawn, read at the cursor and led to."""

from dataclasses import replace

import pytest

from uictest.report.page import sweep_page_html
from uictest.report.sweep.folder import SweepContent
from uictest.report.traces.trace import trace_of

from .builders import make_recording, make_result
from .chromium import run
from .sweep_rows import DRAWN, drawn_rows, row, sweep_result, write_rows

_MAP = """
const map = document.getElementById(arguments[0]);
const empty = map.querySelector('.no-case');
return [map.checkVisibility(), [...map.querySelectorAll('tbody tr')].map((row) =>
  [...row.cells].map((cell) => cell.textContent)), getComputedStyle(empty).backgroundImage];
"""
_OF_STOP = """
const middle = ({x, width, y, height}) => [Math.round(x + width / 2), Math.round(y + height / 2)];
return [...document.querySelectorAll('.of-stop')].map((path) => middle(path.getBoundingClientRect()));
"""
_POINT = """
const svg = document.querySelector('.panels-of-points svg');
const {x, y, width, height} = svg.querySelector('.of-stop').getBoundingClientRect();
const place = {clientX: x + width / 2, clientY: y + height / 2, bubbles: true};
svg.dispatchEvent(new PointerEvent('pointermove', place));
"""
_PANELS = """
const count = (path) => (path.getAttribute('d').match(/M/g) ?? []).length;
return [...document.querySelectorAll('.panels-of-points svg')].map((svg) =>
  [svg.getAttribute('aria-label'), ...[...svg.querySelectorAll('.points')].map(count)]);
"""
_SLIDE = """
const slider = document.querySelector('.point-readout input');
slider.value = arguments[0];
slider.dispatchEvent(new Event('input'));
"""
_RINGS = """
const middle = ({x, width, y, height}) => [Math.round(x + width / 2), Math.round(y + height / 2)];
return [...document.querySelectorAll('.point-ring')].map((each) => middle(each.getBoundingClientRect()));
"""


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """A sample of 60 cases, three of which fail; the first of these is drawn."""
    folder = tmp_path_factory.mktemp("page")
    rows = drawn_rows(60, failing=(7, 8, 9))
    write_rows(folder, rows)
    parameters = {key: rows[7][f"parameters.{key}"] for key in DRAWN}
    worst = make_result(id="study[sample=7]", outcome="fail", parameters=parameters)
    result = replace(sweep_result(DRAWN, 60, logarithmic=["gain"]), worst=(worst,))
    path = folder / "index.html"
    content = SweepContent(folder, result, {}, {worst.id: trace_of(make_recording())})
    path.write_text(sweep_page_html(content), encoding="utf-8")
    return path


def text_of(browser, selector):
    return run(browser, "return document.querySelector(arguments[0]).textContent", selector)


def test_every_point_of_every_panel_is_drawn(browser, page):
    """Without a script, too; a measure with one value, the slide, has no panels."""
    browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    browser.get(page.as_uri())
    panels = run(browser, _PANELS)
    assert [each[1:] for each in panels] == [[57, 3]] * 2
    assert panels[1][0] == "braking distance, m over gain, 1/s, logarithmic"
    key = text_of(browser, ".points-of-cases")
    assert "pass: 57" in key
    assert "fail: 3" in key


def test_the_slider_reads_a_case_and_leads_to_its_stop(browser, page):
    browser.get(page.as_uri())
    run(browser, _SLIDE, 7)
    row = drawn_rows(60)[7]
    read = text_of(browser, ".point-readout output")
    assert read.startswith("study[sample=7]: fail; ")
    assert f"rail.friction {float(row['parameters.rail.friction']):.6g}" in read
    assert f"braking distance {row['braking_distance_m']:.6g} m" in read
    assert run(browser, _RINGS) == run(browser, _OF_STOP)
    run(browser, "document.querySelector('.point-readout output a').click()")
    assert run(browser, "return location.hash") == "#case-study%5Bsample%3D7%5D"


def test_the_pointer_reads_the_point_below_it_in_every_panel(browser, page):
    browser.get(page.as_uri())
    run(browser, _POINT)
    assert text_of(browser, ".point-readout output").startswith("study[sample=7]: fail; ")
    assert run(browser, _RINGS) == run(browser, _OF_STOP)


@pytest.fixture(scope="module")
def with_a_gap(tmp_path_factory):
    """The page of a sweep of three parameters without the cases of a = 1, b = 1; one case fails."""
    folder = tmp_path_factory.mktemp("page")
    values = {key: ["0", "1"] for key in ("a", "c", "b")}
    rows = [
        row(
            f"{a}{b}{c}",
            "fail" if (a, b, c) == (0, 0, 0) else "pass",
            **{"parameters.a": str(a), "parameters.b": str(b), "parameters.c": str(c)},
        )
        for a, b, c in ((0, 0, 0), (0, 0, 1), (0, 1, 0), (0, 1, 1), (1, 0, 0), (1, 0, 1))
    ]
    write_rows(folder, rows)
    path = folder / "index.html"
    path.write_text(sweep_page_html(SweepContent(folder, sweep_result(values, 6), {})), encoding="utf-8")
    return path


def test_a_link_unfolds_its_map_and_a_cell_without_a_case_is_hatched(browser, with_a_gap):
    browser.get(f"{with_a_gap.as_uri()}#map-met-a-b")
    shown, table, ground = run(browser, _MAP, "map-met-a-b")
    assert shown
    assert table == [["0", "50", "100"], ["1", "100", ""]]
    assert "gradient" in ground
