"""The page in a browser: Chromium, headless, driven by selenium; skipped where there is none."""

import time

import pytest

from uictest.judging.evaluation import AppliedDefinition
from uictest.report import CaseDescription
from uictest.report.page import sweep_page_html
from uictest.report.traces.trace import trace_of

from .builders import HOSTILE, make_content, make_recording, make_result, make_verdict
from .chromium import PLOTTED, emulate, resize, run, wait, written


def test_the_missed_case_is_open_and_its_plots_are_drawn_with_the_criteria(browser, page):
    browser.get(page.as_uri())
    assert wait(browser, PLOTTED) > 15
    assert run(browser, "return [...document.querySelectorAll('details.stop[open]')].length") == 1
    assert run(browser, "return document.querySelectorAll('.loops-plot canvas').length") == 2
    assert _bars(browser, "valves") == 4
    kinds = (
        "return document.querySelector('.panels-plot').plots.flatMap(({marks}) => marks.map((m) => m.kind))"
    )
    assert "band" in run(browser, kinds)


def _bars(browser, key):
    """Return how many bars a strip has; of the valves, of the vent magnets."""
    script = """
      const {bars} = document.querySelector('details.stop[open] .panels-plot').plots
        .find(({row}) => row.key === arguments[0]);
      return bars.filter(({opacity}) => arguments[0] !== 'valves' || opacity === 1)
        .reduce((sum, {spans}) => sum + spans.length, 0);
    """
    return int(run(browser, script, key))


def _inked(browser, key, height):
    """Return how many separate stretches are green in a panel, at a share of its height."""
    script = """
      const {plot} = document.querySelector('details.stop[open] .panels-plot').plots
        .find(({row}) => row.key === arguments[0]);
      const {left, top, width, height} = plot.bbox;
      const {data} = plot.ctx.getImageData(left, Math.round(top + arguments[1] * height), width, 1);
      const strong = Array.from({length: width}, (_, k) => data[4 * k + 1] > data[4 * k] + 60);
      return strong.filter((inked, k) => inked && !strong[k - 1]).length;
    """
    return int(run(browser, script, key, height))


def test_every_vent_is_painted_however_short_and_wherever_one_zooms(browser, tmp_path):
    recording = make_recording(34001)
    for n in (1, 2, 3, 4):
        recording[f"valve_command_{n}"][:] = 0.0
    recording["valve_command_2"][1000:33000:100] = 2.0  # a vent of 1 ms every 0.1 s
    result = make_result()
    content = make_content(result, traces={result.id: trace_of(recording)})
    browser.get(written(tmp_path, content).as_uri())
    wait(browser, PLOTTED)
    assert _bars(browser, "valves") == 320
    zoom = "document.querySelector('.panels-plot').plots[0].plot.setScale('x', {min: 9.95, max: 10.35})"
    browser.execute_script(zoom)
    assert wait(browser, "return document.querySelector('.panels-plot').plots[1].plot.scales.x.max < 11")
    time.sleep(0.3)
    below_middle = (2 + 0.32 - 0.5) / 4  # of the vent magnet of the second of four rows
    assert _inked(browser, "valves", below_middle) == 4


def test_the_criterion_that_failed_is_named_and_drawn_first(browser, tmp_path):
    locked = {"wheel_speed_4": 0.0, "slide_4": 1.0}
    recording = make_recording()
    for name, value in locked.items():
        recording[name][500:900] = value
    definitions = tuple(
        AppliedDefinition(name, value, "m/s", "chosen")
        for name, value in (("locked_speed", 0.1), ("moving_speed", 10 / 3.6))
    )
    lock = make_verdict(
        id="locked-wheels", measure="longest_lock", status="fail", value=4.0, unit="s", upper=1.0,
        lower=None, margin=-3.0, definitions=definitions,
    )  # fmt: skip
    result = make_result(outcome="fail", criteria=(make_verdict(measure="braking_distance"), lock))
    content = make_content(result, traces={result.id: trace_of(recording, result.criteria)})
    browser.get(written(tmp_path, content).as_uri())
    wait(browser, PLOTTED)
    criteria = "return [...document.querySelectorAll('table.margins tbody th')].map(h => h.firstChild.data)"
    assert run(browser, criteria) == ["locked-wheels", "braking-distance"]
    assert _bars(browser, "locked") == 1


def test_a_link_from_the_table_opens_its_case(browser, page):
    browser.get(page.as_uri())
    wait(browser, PLOTTED)
    run(browser, "document.querySelector('.verdicts a[href$=dry-120]').click()")
    assert wait(browser, "return document.querySelector('[id=case-dry-120]').open")
    assert wait(browser, "return document.querySelectorAll('[id=case-dry-120] .panels-plot canvas').length")


def test_the_cursor_is_moved_with_the_keyboard_and_read_as_a_table(browser, page):
    browser.get(page.as_uri())
    wait(browser, PLOTTED)
    slider = browser.find_element("css selector", "details[open] .readout input")
    before = slider.get_attribute("aria-valuetext")
    slider.send_keys("\ue014" * 200)  # arrow right, 6.8 s
    assert slider.get_attribute("aria-valuetext") != before
    cells = run(
        browser, "return [...document.querySelectorAll('details[open] .readout td')].map(c => c.innerText)"
    )
    assert "40.0" in cells
    assert "vent" in cells


def test_lines_can_be_switched_off(browser, page):
    browser.get(page.as_uri())
    before = wait(browser, PLOTTED)
    run(browser, "document.querySelector('details[open] .key input[data-role=wheelset-2]').click()")
    assert wait(browser, f"const count = () => {{{PLOTTED}}}; return count() < {before}")


def test_it_can_be_read_without_javascript(browser, page):
    browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    browser.get(page.as_uri())
    text = browser.find_element("tag name", "body").text
    for shown in (
        "3 cases: 1 pass, 1 expected fail, 1 invalid; 1 not as expected",
        "slip-120",
        "Criteria",
        "Wheelsets, 1 leads",
        "Provenance",
    ):
        assert shown in text
    sketch = browser.find_element("css selector", "details[open] svg.panels")
    assert sketch.size["height"] > 300
    hidden = browser.find_elements("css selector", ".filters, .theme, .readout, .key input")
    assert not any(element.is_displayed() for element in hidden)


def test_on_paper_stands_the_drawing_and_no_control(browser, page):
    browser.get(page.as_uri())
    wait(browser, PLOTTED)
    emulate(browser, media="print")
    assert browser.find_element("css selector", "details[open] svg.panels").is_displayed()
    assert not browser.find_element("css selector", "details[open] .panels-plot").is_displayed()
    assert not browser.find_element("css selector", "form.filters").is_displayed()


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
    assert browser.title == "1 case: 1 error; 1 not as expected · uictest"
    assert "<img src=x" in browser.find_element("css selector", ".verdicts th[scope=row]").text


def test_a_thousand_cases_open(browser, tmp_path):
    results = [make_result(id=f"case-{n}", outcome="fail" if n % 7 else "pass") for n in range(1000)]
    trace = trace_of(make_recording(sliding_time="5.0"))
    traces = {result.id: trace for result in results[:40]}
    browser.get(written(tmp_path, make_content(*results, traces=traces)).as_uri())
    assert run(browser, "return document.querySelectorAll('.verdicts tbody tr').length") == 1000
    took = run(browser, "return performance.getEntriesByType('navigation')[0].domComplete")
    print(f"opened in {took:.0f} ms")  # noqa: T201 - shown with -rP; how fast it is depends on the machine
    assert wait(browser, PLOTTED)


@pytest.fixture
def sweep_page(tmp_path, make_sweep):
    """The page of a sweep with a drawn case that was not met."""
    worst = make_result(
        id="study[a]", outcome="fail", parameters={"brake.x": "80 %", "rail.friction": "0.10"}
    )
    traces = {worst.id: trace_of(make_recording())}
    path = tmp_path / "index.html"
    path.write_text(sweep_page_html(make_sweep((worst,), "x", traces=traces)), encoding="utf-8")
    return path


def test_a_sweeps_worst_case_is_drawn_and_reached_from_the_map(browser, sweep_page):
    browser.get(sweep_page.as_uri())
    assert wait(browser, PLOTTED) > 15
    # The page scrolls smoothly: a click with the pointer would come before its end.
    run(browser, "document.querySelector('.swept-map a').click()")
    assert browser.current_url.endswith("#case-study%5Ba%5D")


def test_a_sweep_can_be_read_without_javascript(browser, sweep_page):
    browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    browser.get(sweep_page.as_uri())
    text = browser.find_element("tag name", "body").text
    for shown in (
        "4 cases: 3 pass, 1 fail; 1 not as expected",
        "study[a]",
        "Measures over rail.friction",
        "Frontier along",
        "Provenance",
    ):
        assert shown in text
    assert (
        browser.find_element("css selector", "section[aria-labelledby=lines-1] svg.plot").size["height"] > 100
    )


_ENDS = """
return [...document.querySelectorAll(arguments[0])].map(each => each.getBoundingClientRect().right)
"""


@pytest.mark.parametrize("width", [1400, 390])
def test_figures_and_frontier_of_a_sweep_are_in_sight_without_scrolling(browser, tmp_path, make_sweep, width):
    flips = [{"low": "0.10", "high": "0.12", "met_at_low": False}]
    stretches = [
        {"circumstances": {"speed": f"{speed} km/h"}, "flips": flips, "note": ""} for speed in (60, 90)
    ]
    index = {"value": 0.512, "low": 0.412, "high": 0.612}
    sensitivity = {
        "measure": "braking_distance_m",
        "circumstances": {},
        "key": "brake.system.wsp_valve.vent_conductance",
    }
    content = make_sweep(
        text="x",
        frontier={"parameter": "rail.friction", "stretches": stretches},
        sensitivities=[{**sensitivity, "first": index, "total": index}],
    )
    path = tmp_path / "index.html"
    path.write_text(sweep_page_html(content), encoding="utf-8")
    resize(browser, width)
    browser.get(path.as_uri())
    for shown in (".indices td.number", ".worst td.number", "svg.frontier"):
        ends = run(browser, _ENDS, shown)
        assert ends
        assert max(ends) <= width
