"""One stop on a page in a browser: where values were taken, links, commands, points of the plots."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from uictest.judging.evaluation import AppliedDefinition
from uictest.report import RunManifest
from uictest.report.traces.trace import trace_of

from .builders import make_content, make_recording, make_result, make_verdict
from .chromium import PLOTTED, emulate, resize, run, wait, written

CASE = "slip 120[friction=0.09]"
READY = "return document.querySelector('.plots[data-ready]') !== null"


@pytest.fixture(scope="module")
def stop_page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A stop whose wheelset 3 has the largest slide above the cut-off, 60 % at 8 s; 35 % are allowed."""
    recording = make_recording(sliding_time="5.0")
    largest = np.where(np.isclose(recording["time"], 8.0), 0.6, recording["slide_3"])
    own = {"slide_3": largest, "wheel_speed_3": recording["speed"] * (1.0 - largest)}
    recording = replace(recording, channels={**recording.channels, **own})
    definitions = tuple(
        AppliedDefinition(name, speed / 3.6, "m/s", "stated")
        for name, speed in (("low_speed_cutoff", 30.0), ("moving_speed", 10.0))
    )
    slide = make_verdict(
        id="largest-slide", measure="maximum_slide_above_cutoff", value=60.0, unit="%",
        lower=None, upper=35.0, margin=-25.0, status="fail", definitions=definitions,
    )  # fmt: skip
    result = make_result(
        id=CASE, scenario="scenarios/slip.yaml", outcome="fail", criteria=(make_verdict(), slide)
    )
    manifest = RunManifest(command=("uictest", "run", "scenarios", "--set", "rail.friction=0.09", "-n", "2"))
    traces = {CASE: trace_of(recording, result.criteria)}
    return written(tmp_path_factory.mktemp("page"), make_content(result, manifest=manifest, traces=traces))


def test_a_criterion_leads_to_the_instant_at_which_its_value_was_taken(browser: Any, stop_page: Path) -> None:
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    button = browser.find_element("css selector", "button.moment")
    assert button.text == "8 s, wheelset 3"
    button.send_keys("\ue007")
    assert browser.find_element("css selector", ".readout output").text == "8.00 s"
    assert button.get_attribute("aria-pressed") == "true"
    ring, place = run(
        browser,
        """
        const panels = document.querySelector('.panels-plot');
        const {left, top} = panels.getBoundingClientRect();
        const box = panels.querySelector('.ring').getBoundingClientRect();
        const {x, y} = panels.placeOf('slide', 3);
        const {[x]: across, [y]: up} = panels._fullLayout;
        return [[box.x + box.width / 2 - left, box.y + box.height / 2 - top],
                [across._offset + across.l2p(8), up._offset + up.l2p(60)]];
        """,
    )
    assert ring == pytest.approx(place, abs=1.0)
    button.send_keys("\ue007")
    assert button.get_attribute("aria-pressed") == "false"
    assert not browser.find_element("css selector", ".ring").is_displayed()


def test_what_failed_leads_from_the_top_of_the_page_to_its_instant(browser: Any, stop_page: Path) -> None:
    browser.get(stop_page.as_uri())
    link = browser.find_element("css selector", "section.findings a[data-criterion]")
    assert link.text == "at 8 s, wheelset 3"
    run(browser, "document.querySelector('details.stop').open = false")
    link.click()
    assert wait(browser, "return document.querySelector('button.moment[aria-pressed=true]') !== null")
    assert browser.find_element("css selector", ".readout output").text == "8.00 s"
    assert browser.find_element("css selector", ".ring").is_displayed()


def test_a_vent_leads_to_its_instant(browser: Any, stop_page: Path) -> None:
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    run(browser, "document.querySelector('table.vents').closest('details').open = true")
    button = browser.find_element("css selector", "table.vents tbody tr:nth-child(2) button")
    button.send_keys("\ue007")
    assert browser.find_element("css selector", ".readout output").text == f"{button.text} s"
    assert browser.find_element("css selector", ".spotlight").is_displayed()


def test_the_ring_follows_its_wheelset_where_they_stand_side_by_side(browser: Any, stop_page: Path) -> None:
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    browser.find_element("css selector", "button.moment").click()
    _choose(browser, ".plots", "view", "apart")
    wait(browser, "return document.querySelector('.panels-plot')._fullLayout.xaxis4 !== undefined")
    assert run(browser, "return document.querySelector('.panels-plot').placeOf('slide', 3).x") == "xaxis3"
    lines = "return [...document.querySelectorAll('.cursor-line')].filter((each) => !each.hidden).length"
    assert wait(browser, lines) == 4
    ranges = run(
        browser,
        "const l = document.querySelector('.panels-plot')._fullLayout;"
        "return ['yaxis', 'yaxis2', 'yaxis3', 'yaxis4'].map((name) => l[name].range)",
    )
    assert all(each == ranges[0] for each in ranges)
    assert ranges[0][1] > 119


@pytest.mark.parametrize("width", [400, 1000, 1600])
def test_the_values_of_the_cursor_lie_beside_the_plots_and_never_over_the_loops(
    browser: Any, stop_page: Path, width: int
) -> None:
    resize(browser, width)
    browser.get(stop_page.as_uri())
    wait(browser, PLOTTED)
    overlap = run(
        browser,
        """
        document.querySelector('.plots .loops').scrollIntoView({block: 'start', behavior: 'instant'});
        const [a, b] = ['.plots .loops', '.readout'].map((name) =>
          document.querySelector(name).getBoundingClientRect());
        return Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        """,
    )
    assert overlap <= 0


def test_labels_lie_above_the_panels_and_not_over_each_other(browser: Any, stop_page: Path) -> None:
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    boxes = run(
        browser,
        "return [...document.querySelectorAll('.panels-plot .annotation-text')]"
        ".map((each) => each.getBoundingClientRect())"
        ".map((box) => [box.left, box.right, box.top, box.bottom])",
    )
    assert len(boxes) >= 8
    for k, first in enumerate(boxes):
        for second in boxes[k + 1 :]:
            assert not _overlap(first, second)


def _overlap(first: list[float], second: list[float]) -> bool:
    across = first[0] < second[1] - 1 and second[0] < first[1] - 1
    return across and first[2] < second[3] - 2 and second[2] < first[3] - 2


def _choose(browser: Any, within: str, name: str, value: str) -> None:
    run(
        browser,
        "const choice = document.querySelector(`${arguments[0]} select[data-choice=${arguments[1]}]`);"
        "choice.value = arguments[2]; choice.dispatchEvent(new Event('change', {bubbles: true}))",
        within,
        name,
        value,
    )


@pytest.mark.parametrize("link", ["#case-slip%20120%5Bfriction%3D0.09%5D", "#case-slip 120[friction=0.09]"])
def test_a_link_to_a_case_opens_it_whichever_way_it_is_encoded(
    browser: Any, stop_page: Path, link: str
) -> None:
    browser.get(stop_page.as_uri())
    run(browser, "document.querySelector('details.stop').open = false; location.hash = arguments[0]", link)
    assert wait(browser, "return document.querySelector('details.stop').open")


def test_the_link_and_the_command_can_be_copied(browser: Any, stop_page: Path) -> None:
    browser.get(stop_page.as_uri())
    copied = run(
        browser,
        """
        const texts = [];
        Object.defineProperty(navigator, 'clipboard', {value: {writeText: async (text) => texts.push(text)}});
        document.querySelectorAll('.stop button.copy').forEach((button) => button.click());
        return texts;
        """,
    )
    assert copied == [
        f"{stop_page.as_uri()}#case-slip%20120%5Bfriction%3D0.09%5D",
        f"uictest run scenarios/slip.yaml --set rail.friction=0.09 -k '{CASE}'",
    ]
    assert wait(browser, "return document.querySelector('.stop .copied').textContent") == "Copied command."


def test_the_points_of_a_plot_come_as_csv_with_their_sampling(browser: Any, stop_page: Path) -> None:
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    text = _downloaded(browser, "Slide")
    comments = [line for line in text.splitlines() if line.startswith("#")]
    assert comments[0] == f"# case: {CASE}"
    assert "Sampled every 10 ms" in comments[2]
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    third = [row for row in rows if row["line"] == "slide of wheelset 3"]
    times, values = (np.array([float(row[key] or "nan") for row in third]) for key in ("time_s", "value"))
    # The train is at rest at the end of the record: a slide is no number there.
    assert np.isnan(values[-1])
    times, values = times[~np.isnan(values)], values[~np.isnan(values)]
    assert {row["unit"] for row in third} == {"%"}
    assert times[values.argmax()] == pytest.approx(8.0)
    assert values.max() == pytest.approx(60.0, abs=60 / 32766)
    assert (np.diff(times) > 0).all()
    valves = _downloaded(browser, "WSP valves")
    assert "vent" in valves


def _downloaded(browser: Any, title: str) -> str:
    """Return the text that a button saves."""
    run(
        browser,
        """
        window.saved = null;
        URL.createObjectURL = (blob) => { blob.text().then((text) => { window.saved = text; }); return '#'; };
        const buttons = [...document.querySelectorAll('.tables button')];
        buttons.find((each) => each.textContent === arguments[0]).click();
        """,
        title,
    )
    return str(wait(browser, "return window.saved"))


def test_the_loops_are_those_of_the_wheelset_that_is_chosen(browser: Any, stop_page: Path) -> None:
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    roles = "return [...new Set(document.querySelector('.loops-plot').data.map((trace) => trace.meta))]"
    assert run(browser, roles) == ["train", "wheelset-1"]
    _choose(browser, ".plots", "wheelset", "3")
    assert run(browser, roles) == ["train", "wheelset-3"]
    names = "return document.querySelector('.loops-plot').data.map((trace) => trace.name)"
    assert {"rising", "falling"} <= set(run(browser, names))


def test_on_a_phone_case_verdict_and_measures_are_in_sight(browser: Any, stop_page: Path) -> None:
    resize(browser, 400)
    browser.get(stop_page.as_uri())
    script = """
      const cells = [...document.querySelectorAll('.verdicts tbody tr:first-child > *')];
      return cells.map((cell) => cell.getBoundingClientRect()).map(({left, right}) => [left, right]);
    """
    ends = run(browser, script)
    assert len(ends) >= 10
    assert all(left >= 0 and right <= 400 for left, right in ends)


def test_paper_has_the_name_of_the_run_and_the_numbers_of_its_pages(browser: Any, stop_page: Path) -> None:
    browser.get(stop_page.as_uri())
    emulate(browser, media="print")
    rules = run(
        browser,
        "return [...document.styleSheets[0].cssRules].filter((rule) => rule instanceof CSSPageRule)"
        ".map((rule) => rule.cssText).join(' ')",
    )
    assert "a-run" in rules.replace("\\2d ", "-")
    assert "counter(page)" in rules
    head = "return getComputedStyle(document.querySelector('.verdicts thead')).display"
    assert run(browser, head) == "table-header-group"
