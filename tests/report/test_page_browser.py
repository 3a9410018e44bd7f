"""The pages of runs and sweeps in a browser: Chromium, headless, driven by selenium."""

import json
import re
from xml.etree import ElementTree

import numpy as np
import pytest

from uictest.cli.entry import execute
from uictest.core.recording import read_parquet
from uictest.report import CaseDescription
from uictest.report.page import sweep_page_html
from uictest.report.sweep.result import SweepContent
from uictest.report.traces.trace import trace_of

from .builders import HOSTILE, make_content, make_recording, make_result
from .chromium import COMPARED, PLOTTED, READY, by_head, click, resize, run, step_to, texts, wait, written
from .sweep_rows import row, sweep_result, write_rows


@pytest.fixture
def opened(browser, page):
    """The browser, in which the missed one of three cases is open and drawn."""
    browser.get(page.as_uri())
    wait(browser, PLOTTED)
    return browser


def test_the_missed_case_is_open_and_drawn_with_its_criteria_and_lines_can_be_switched_off(opened):
    lines = wait(opened, PLOTTED)
    assert lines > 15
    assert texts(opened, "details.stop[open] h3") == ["slip-120"]
    assert len(texts(opened, ".loops-plot canvas")) == 2
    plots = "return document.querySelector('.panels-plot').plots"
    vents = f"{plots}.find(({{row}}) => row.key === 'valves').bars.filter(({{opacity}}) => opacity === 1)"
    assert run(opened, f"{vents}.flatMap(({{spans}}) => spans).length") == 4
    assert "band" in run(opened, f"{plots}.flatMap(({{marks}}) => marks.map((m) => m.kind))")
    click(opened, "details[open] .key input[data-role=wheelset-2]")
    assert wait(opened, f"const count = () => {{{PLOTTED}}}; return count() < {lines}")


def test_a_link_from_the_table_opens_its_case(opened):
    click(opened, ".verdicts a[href$=dry-120]")
    assert wait(opened, "return document.querySelector('[id=case-dry-120]').open")
    assert wait(opened, "return document.querySelectorAll('[id=case-dry-120] .panels-plot canvas').length")


def test_it_can_be_read_without_javascript(browser, page):
    browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    browser.get(page.as_uri())
    text = browser.find_element("tag name", "body").text
    counts = "1 of 3 cases is not a valid test: slip-120"
    for shown in (counts, "slip-120", "Criteria", "Wheelsets, 1 leads", "Provenance"):
        assert shown in text
    sketch = browser.find_element("css selector", "details[open] svg.panels")
    assert sketch.size["height"] > 300
    hidden = browser.find_elements("css selector", ".filters, .theme, .readout, .key input")
    assert not any(element.is_displayed() for element in hidden)


def test_hostile_texts_are_not_executed(browser, tmp_path):
    take = "document.title = 'taken'"
    bad = f'{HOSTILE}</script><script>{take}</script><img src=x onerror="{take}">'
    result = make_result(id=bad, scenario=bad, outcome="error", reason=bad)
    content = make_content(
        result,
        name=bad,
        subjects={bad: CaseDescription(bad, (bad,), {bad: bad})},
        traces={bad: trace_of(make_recording())},
    )
    browser.get(written(tmp_path, content).as_uri())
    wait(browser, PLOTTED)
    assert run(browser, "return document.images.length") == 0
    assert browser.title.startswith("1 of 1 case could not be run")
    assert "<img src=x" in browser.find_element("css selector", ".verdicts th[scope=row]").text


def _compare(browser, *numbers):
    """Choose cases in the table, and wait until they are laid over each other."""
    for number in numbers:
        run(browser, "document.querySelectorAll('tbody .compare')[arguments[0]].click()", number)
    assert wait(browser, COMPARED) == len(numbers)


def test_cases_stand_in_one_plot_with_one_time_axis(opened):
    assert not opened.find_element("id", "compared").is_displayed()
    run(opened, "document.querySelector('tbody .compare').click()")
    assert opened.find_element("css selector", ".comparison-bar").text.startswith("1 case chosen")
    run(opened, "document.querySelector('tbody .compare').click()")
    _compare(opened, 0, 2)
    names = texts(opened, ".cases a")
    assert names == ["slip-120", "dry-120"]
    traces = run(
        opened,
        "return document.querySelector('.compared-plot').plots.flatMap(({lines, plot}) => lines.map((each) =>"
        " [each.label, each.ink, String(each.dash), plot.scales.x.max]))",
    )
    by_case = {name: {tuple(style) for own, *style in traces if own == name} for name in names}
    ((first,), (second,)) = by_case.values()
    assert first[0] != second[0]
    assert first[1] != second[1]
    assert first[2] == second[2]
    run(opened, "document.querySelectorAll('tbody .compare')[1].click()")
    assert wait(opened, f"const count = () => {{{COMPARED}}}; return count() === 3")


def test_the_cursor_reads_every_case_next_to_its_measures_until_the_comparison_is_cleared(opened):
    _compare(opened, 0, 1)
    step_to(opened, opened.find_element("css selector", "#compared input[type=range]"), 294)  # 10 s
    rows = by_head(opened, ".values tbody tr")
    assert rows["slide, %"] == ["40.0", "40.0"]
    assert rows["train, km/h"] == ["84.0", "84.0"]
    assert rows["braking distance"] == ["465.2 m", "465.2 m"]
    opened.find_element("css selector", "#compared .clear").click()
    assert wait(opened, "return document.querySelector('#compared').hidden")
    assert texts(opened, "input.compare:checked") == []
    assert run(opened, "return document.activeElement.matches('input.compare')")


SCALES = {"km/h": 1 / 3.6, "%": 0.01, "bar": 1e5, "kN": 1e3, "m": 1.0, "1": 1.0}
ROWS = {"wheelset, km/h": "wheel_speed", "slide, %": "slide", "tank, bar": "tank_pressure"}
ROWS |= {"cylinder, bar": "cylinder_pressure", "clamping force, kN": "clamping_force", "adhesion": "adhesion"}
TRAIN = {"train, km/h": "speed", "distance, m": "distance"}
TRAIN |= {"brake line, bar": "brake_line_pressure", "reservoir, bar": "reservoir_pressure"}


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """The folder of a run of one stop that misses a criterion, with its recording."""
    output = tmp_path_factory.mktemp("run")
    words = ["run", "low-adhesion-80", "--set", "expect=pass", "--record", "all", "-o", str(output), "-q"]
    assert execute(words) == 1
    return (output / "latest").resolve()


def test_junit_says_when_a_value_was_taken_as_the_page_does_but_not_of_a_stop_that_is_not_drawn(
    finished, tmp_path
):
    (case,) = ElementTree.parse(finished / "junit.xml").iter("testcase")
    (instant,) = re.findall(r"total-locked-time .*\(taken at (.*)\)", "".join(case.itertext()))
    assert re.fullmatch(r"[\d.]+ to [\d.]+ s, wheelset [1-4]", instant)
    assert instant in (finished / "index.html").read_text("utf-8")
    assert execute(["report", str(finished), "--format", "junit", "-o", str(tmp_path)]) == 0
    again = (tmp_path / "junit.xml").read_text("utf-8")
    assert "total-locked-time" in again
    assert "taken at" not in again


@pytest.fixture
def stop(browser, finished):
    """The browser, in which the plots of the stop answer."""
    browser.get((finished / "index.html").as_uri())
    run(browser, "document.querySelector('details.stop').open = true")
    run(browser, "document.querySelector('details.stop .plots').scrollIntoView()")  # drawn when it comes near
    wait(browser, READY)
    return browser


def test_the_cursor_reads_what_was_recorded_and_the_tables_what_results_hold(stop, finished):
    recording = read_parquet(finished / "recordings" / "low-adhesion-80.parquet")
    (result,) = json.loads((finished / "results.json").read_text("utf-8"))["cases"]
    time = recording["time"]
    compared = 0
    for share in (0.013, 0.17, 0.331, 0.502, 0.678, 0.85):
        moved = run(
            stop,
            "const slider = document.querySelector('.readout input'); slider.value = arguments[0] * 1000;"
            "slider.dispatchEvent(new Event('input')); return slider.value / 1000;",
            share,
        )
        cells = by_head(stop, ".readout tbody tr, .train-readout div")
        at = time[0] + moved * (time[-1] - time[0])
        for head, key in (ROWS | TRAIN).items():
            scale = SCALES[head.partition(", ")[2] or "1"]
            names = [key] if head in TRAIN else [f"{key}_{n}" for n in (1, 2, 3, 4)]
            for shown, name in zip(cells[head], names, strict=True):
                last_digit = 10.0 ** -len(shown.partition(".")[2])
                expected = float(np.interp(at, time, recording[name])) / scale
                assert float(shown) == pytest.approx(expected, abs=0.76 * last_digit), f"{name} at {at} s"
                compared += 1
    assert compared == 6 * 28
    # Every vent of the counters is in the table and in the plots.
    counted = [wheelset["valve_actuations"] for wheelset in result["wheelsets"]]
    numbers = texts(stop, ".vents tbody td:nth-child(2)")
    assert [numbers.count(str(n)) for n in (1, 2, 3, 4)] == counted
    spans = run(
        stop,
        "return document.querySelector('.panels-plot').plots.find(({row}) => row.key === 'valves').bars"
        ".filter(({opacity}) => opacity === 1).map(({spans}) => spans.length)",
    )
    assert spans == counted
    shown = run(
        stop,
        "return Object.fromEntries([...document.querySelectorAll('table.margins tbody tr')].map((row) =>"
        " [row.querySelector('th').firstChild.data.trim(), row.textContent]))",
    )
    judged = [each for each in result["criteria"] if each["layer"] != "rig" and each["value"] is not None]
    assert len(judged) >= 4
    assert [each["id"] for each in judged if f"{each['value']:.4g}" not in shown[each["id"]]] == []
    distance = float(texts(stop, "details.stop .figures dd")[0].split()[0])
    assert distance == pytest.approx(result["measures"]["braking_distance_m"], rel=5e-4)


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


def test_a_map_a_worst_case_and_the_text_of_a_sweep_are_reached_with_scripts_and_without(browser, sweep_page):
    browser.get(sweep_page.as_uri())
    assert wait(browser, PLOTTED) > 15
    click(browser, ".swept-map a")
    assert browser.current_url.endswith("#case-study%5Ba%5D")
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
    for shown in (".indices td.number", "svg.frontier"):
        ends = run(
            browser,
            "return [...document.querySelectorAll(arguments[0])].map((e) => e.getBoundingClientRect().right)",
            shown,
        )
        assert ends
        assert max(ends) <= width
