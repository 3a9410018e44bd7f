"""The page of a run in a browser: Chromium, headless, driven by selenium; skipped where there is none."""

import pytest

from uictest.report import CaseDescription
from uictest.report.traces.trace import trace_of

from .builders import HOSTILE, make_content, make_recording, make_result
from .chromium import COMPARED, PLOTTED, by_head, click, run, step_to, texts, wait, written


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
    counts = "3 cases: 1 pass, 1 expected fail, 1 invalid; 1 not as expected"
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
    assert browser.title == "1 case: 1 error; 1 not as expected · uictest"
    assert "<img src=x" in browser.find_element("css selector", ".verdicts th[scope=row]").text


def test_a_thousand_cases_open(browser, tmp_path):
    results = [make_result(id=f"case-{n}", outcome="fail" if n % 7 else "pass") for n in range(1000)]
    trace = trace_of(make_recording(sliding_time="5.0"))
    traces = {result.id: trace for result in results[:40]}
    browser.get(written(tmp_path, make_content(*results, traces=traces)).as_uri())
    assert run(browser, "return document.querySelectorAll('.verdicts tbody tr').length") == 1000
    assert wait(browser, PLOTTED)


def _compare(browser, *numbers):
    """Choose cases in the table, and wait until they are laid over each other."""
    for number in numbers:
        run(browser, "document.querySelectorAll('tbody .compare')[arguments[0]].click()", number)
    assert wait(browser, COMPARED) == len(numbers)


def test_two_cases_stand_in_one_plot_with_one_time_axis(opened):
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


def test_all_of_three_cases_can_be_compared(opened):
    _compare(opened, 0, 1, 2)
