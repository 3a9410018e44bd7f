"""Maps and points of a sweep in a browser: what is chosen, read at the cursor, led to, downloaded."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from uictest.report.page import sweep_page_html
from uictest.report.sweep.folder import SweepContent
from uictest.report.traces.trace import trace_of

from .builders import make_recording, make_result
from .chromium import run
from .sweep_rows import DRAWN, drawn_rows, row, sweep_result, write_rows

_SAVED = """
window.saved = [];
URL.createObjectURL = (blob) => { saved.push(blob.text()); return 'data:,'; };
const places = ['.heat button.csv', '.scatter button.csv', '[data-table]'];
for (const place of places) document.querySelector(place).click();
return Promise.all(saved);
"""
_SAVED_MAP = """
window.saved = [];
URL.createObjectURL = (blob) => { saved.push(blob.text()); return 'data:,'; };
document.getElementById(arguments[0]).querySelector('button.csv').click();
return Promise.all(saved);
"""
_SHOWN = """
const maps = [...document.querySelectorAll('.heat:not([hidden])')];
return maps.filter((each) => !each.closest('[hidden]')).map((each) => each.id);
"""
_CHOOSE = """
const box = document.querySelector(`[data-choice="${arguments[0]}"]`);
box.value = arguments[1];
box.dispatchEvent(new Event('change'));
"""
_PRESS = """
const view = document.querySelector('.heat-view');
view.focus();
view.dispatchEvent(new KeyboardEvent('keydown', {key: arguments[0], bubbles: true}));
"""
_READ = """
return [...document.querySelectorAll('.heat:not([hidden])')].map((figure) => [
  figure.querySelector('output').textContent,
  ...[...figure.querySelector('tbody').rows[1].cells[2].childNodes].map((node) => node.textContent),
]);
"""
_POINT = """
const [column, row] = arguments;
const svg = document.querySelector('.heat-plot');
const box = svg.getBoundingClientRect();
const middle = (name, k) => {
  const edges = svg.dataset[name].split(' ').map(Number);
  return (edges[k] + edges[k + 1]) / 2 * box.width / svg.viewBox.baseVal.width;
};
const [clientX, clientY] = [box.left + middle('x', column), box.top + middle('y', row)];
svg.parentElement.dispatchEvent(new PointerEvent('pointermove', {clientX, clientY, bubbles: true}));
"""
_PANELS = """
const count = (path) => (path.getAttribute('d').match(/M/g) ?? []).length;
return [...document.querySelectorAll('.panels-of-points svg')].map((svg) =>
  [svg.getAttribute('aria-label'), ...[...svg.querySelectorAll('.points')].map(count)]);
"""
_SLIDE = """
const slider = document.querySelector('.scatter-readout input');
slider.value = arguments[0];
slider.dispatchEvent(new Event('input'));
"""
_LABELS = """
const labels = document.querySelector('.panels-of-points svg').querySelectorAll('.tick.middle');
return [...labels].map((each) => each.textContent);
"""
_RINGS = """
const rings = [...document.querySelectorAll('.point-ring')];
return rings.map((each) => each.getAttribute('visibility'));
"""


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
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


def text_of(browser: Any, selector: str) -> str:
    found: str = run(browser, "return document.querySelector(arguments[0]).textContent", selector)
    return found


def test_a_measure_is_chosen_beside_the_verdicts(browser: Any, page: Path) -> None:
    browser.get(page.as_uri())
    names = ("met", "braking-distance", "largest-slide")
    verdicts, distance, slide = (f"map-{name}-rail.friction-gain" for name in names)
    assert run(browser, _SHOWN) == [verdicts, distance]
    run(browser, _CHOOSE, "measure", "largest slide")
    assert run(browser, _SHOWN) == [verdicts, slide]


def test_a_link_leads_to_its_map(browser: Any, page: Path) -> None:
    browser.get(f"{page.as_uri()}#map-largest-slide-rail.friction-gain")
    assert "map-largest-slide-rail.friction-gain" in run(browser, _SHOWN)


def test_arrow_keys_read_every_map_cell_by_cell(browser: Any, page: Path) -> None:
    """From the first cell, the lowest and leftmost, one up and one to the right: the table has the same."""
    browser.get(page.as_uri())
    for key in ("ArrowUp", "ArrowUp", "ArrowRight"):
        run(browser, _PRESS, key)
    read = run(browser, _READ)
    assert len(read) == 2
    for output, value, cases in read:
        assert output.startswith("rail.friction = 0.11 .. 0.12, gain = 0.1 .. 1 1/s: ")
        assert f": {value} (" in output
        assert cases in output


def test_the_pointer_reads_the_cell_below_it(browser: Any, page: Path) -> None:
    browser.get(page.as_uri())
    run(browser, _POINT, 1, 9)
    assert text_of(browser, ".heat output").startswith("rail.friction = 0.19 .. 0.2, gain = 0.1 .. 1 1/s:")


def test_every_point_of_every_panel_is_drawn(browser: Any, page: Path) -> None:
    browser.get(page.as_uri())
    panels = run(browser, _PANELS)
    assert [each[1:] for each in panels] == [[57, 3]] * 4
    assert panels[1][0] == "braking distance, m over gain, 1/s, logarithmic"
    key = text_of(browser, ".scatter-key")
    assert "pass: 57" in key
    assert "fail: 3" in key
    shown = text_of(browser, ".scatter-shown")
    assert shown.startswith("Panels: 2 of 2 parameters across, 2 of 2 measures up")


@pytest.mark.parametrize(
    ("values", "labels"),
    [([32000, 32010], ["32000", "32005", "32010"]), ([1, 4294967295], ["0", "2000000000", "4000000000"])],
)
def test_an_axis_of_points_says_where_its_ticks_are(
    browser: Any, page: Path, tmp_path: Path, values: list[float], labels: list[str]
) -> None:
    """Numbers close to each other keep their digits; those far apart, as seeds, are drawn as well."""
    before, start, rest = page.read_text(encoding="utf-8").partition('id="scatter-data">')
    text, end, after = rest.partition("</script>")
    data = json.loads(text)
    data["parameters"][0]["values"] = np.linspace(*values, len(data["ids"])).tolist()
    changed = tmp_path / "index.html"
    changed.write_text("".join([before, start, json.dumps(data), end, after]), encoding="utf-8")
    browser.get(changed.as_uri())
    assert run(browser, _LABELS) == labels


def test_a_panel_is_taken_away_and_the_text_says_so(browser: Any, page: Path) -> None:
    browser.get(page.as_uri())
    run(browser, "document.querySelector('input[name=\"scatter-parameter\"]').click()")
    assert len(run(browser, _PANELS)) == 2
    assert "Panels: 1 of 2 parameters across" in text_of(browser, ".scatter-shown")


def test_the_slider_reads_a_case_and_leads_to_its_stop(browser: Any, page: Path) -> None:
    browser.get(page.as_uri())
    run(browser, _SLIDE, 7)
    row = drawn_rows(60)[7]
    read = text_of(browser, ".scatter-readout output")
    assert read.startswith("study[sample=7]: fail; ")
    assert f"rail.friction {float(row['parameters.rail.friction']):.6g}" in read
    assert f"braking distance {row['braking_distance_m']:.6g} m" in read
    assert run(browser, _RINGS) == ["visible"] * 4
    run(browser, "document.querySelector('.scatter-readout output a').click()")
    assert run(browser, "return location.hash") == "#case-study%5Bsample%3D7%5D"


def test_what_is_behind_the_plots_is_downloaded(browser: Any, page: Path) -> None:
    browser.get(page.as_uri())
    heat, points, distributions = run(browser, _SAVED)
    assert heat.splitlines()[0] == 'rail.friction,gain,"Cases met, %",cases'
    assert len(heat.splitlines()) == 1 + 10 * 2
    lines = points.splitlines()
    assert lines[0] == 'case,verdict,rail.friction,"gain, 1/s","braking distance, m","largest slide, %"'
    assert lines[8].startswith("study[sample=7],fail,")
    assert len(lines) == 61
    assert distributions.splitlines()[:2] == ["measure,unit,from,to,pass", "braking distance,m,0.0,1.0,60"]


@pytest.fixture(scope="module")
def with_a_gap(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a sweep of three parameters without the cases of a = 1, b = 1."""
    folder = tmp_path_factory.mktemp("page")
    values = {key: ["0", "1"] for key in ("a", "c", "b")}
    rows = [
        row(f"{a}{b}{c}", **{"parameters.a": str(a), "parameters.b": str(b), "parameters.c": str(c)})
        for a, b, c in ((0, 0, 0), (0, 0, 1), (0, 1, 0), (0, 1, 1), (1, 0, 0), (1, 0, 1))
    ]
    write_rows(folder, rows)
    path = folder / "index.html"
    path.write_text(sweep_page_html(SweepContent(folder, sweep_result(values, 6), {})), encoding="utf-8")
    return path


def test_a_cell_without_a_case_has_no_value_and_is_hatched_in_every_pair(
    browser: Any, with_a_gap: Path
) -> None:
    """A pattern inside of the drawing that another choice hides would not be painted."""
    browser.get(with_a_gap.as_uri())
    run(browser, _CHOOSE, "pair", "2")
    [shown] = run(browser, _SHOWN)  # all cases are met: a map that says so in every cell is left out
    assert shown.endswith("-a-b")
    assert shown != "map-met-a-b"
    [table] = run(browser, _SAVED_MAP, shown)
    assert table.splitlines()[-1] == "1,1,,no case"
    assert run(browser, "return document.querySelector('.heat-pair:not([hidden]) path.no-case') !== null")
    assert run(browser, "return document.getElementById('no-case').closest('[hidden]') === null")
