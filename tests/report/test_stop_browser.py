"""One stop on a page in a browser: where values were taken, links, commands, points of the plots."""

import csv
from dataclasses import replace

import numpy as np
import pytest

from uictest.judging.evaluation import AppliedDefinition, RepeatedStop, Repeats
from uictest.report import RunManifest
from uictest.report.traces.band import stop_extremes, with_band
from uictest.report.traces.quantities import PANELS
from uictest.report.traces.trace import trace_of

from .builders import make_content, make_recording, make_result, make_verdict
from .chromium import PLOTTED, emulate, resize, run, step_to, wait, written

CASE = "slip 120[friction=0.09]"
_FURTHER = {
    "dynamic_torque": "N m",
    "dynamic_reduction": "1",
    "friction": "1",
    "cleaned_share": "1",
    "sand_density": "kg/m",
    "disc_temperature": "K",
    "disc_surface_temperature": "K",
}
READY = "return document.querySelector('.plots[data-ready]') !== null"


@pytest.fixture(scope="module")
def stop_page(tmp_path_factory):
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


def test_a_criterion_leads_to_the_instant_at_which_its_value_was_taken(browser, stop_page):
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
        const {plot} = panels.plots.find(({row}) => row.key === 'slide');
        const over = plot.over.getBoundingClientRect();
        return [[box.x + box.width / 2 - left, box.y + box.height / 2 - top],
                [over.x - left + plot.valToPos(8, 'x'), over.y - top + plot.valToPos(60, 'y')]];
        """,
    )
    assert ring == pytest.approx(place, abs=1.0)
    button.send_keys("\ue007")
    assert button.get_attribute("aria-pressed") == "false"
    assert not browser.find_element("css selector", ".ring").is_displayed()


def test_what_failed_leads_from_the_top_of_the_page_to_its_instant(browser, stop_page):
    browser.get(stop_page.as_uri())
    link = browser.find_element("css selector", "section.findings a[data-criterion]")
    assert link.text == "at 8 s, wheelset 3"
    run(browser, "document.querySelector('details.stop').open = false")
    link.click()
    assert wait(browser, "return document.querySelector('button.moment[aria-pressed=true]') !== null")
    assert browser.find_element("css selector", ".readout output").text == "8.00 s"
    assert browser.find_element("css selector", ".ring").is_displayed()


def test_a_vent_leads_to_its_instant(browser, stop_page):
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    run(browser, "document.querySelector('table.vents').closest('details').open = true")
    button = browser.find_element("css selector", "table.vents tbody tr:nth-child(2) button")
    button.send_keys("\ue007")
    assert browser.find_element("css selector", ".readout output").text == f"{button.text} s"
    assert browser.find_element("css selector", ".spotlight").is_displayed()


def test_the_ring_follows_its_wheelset_where_they_stand_side_by_side(browser, stop_page):
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    browser.find_element("css selector", "button.moment").click()
    _choose(browser, ".plots", "view", "apart")
    own = "document.querySelector('.panels-plot').plots.filter(({row}) => row.key === arguments[0])"
    assert wait(browser, f"return {own}.length === 4", "slide")
    rings = f"return {own}.map(({{plot}}) => plot.over.querySelector('.ring:not([hidden])') !== null)"
    wait(browser, "return document.querySelector('.ring:not([hidden])') !== null")
    assert run(browser, rings, "slide") == [False, False, True, False]
    lines = f"return {own}.filter(({{plot}}) => plot.over.querySelector('.cursor-line:not([hidden])')).length"
    assert run(browser, lines, "slide") == 4
    ranges = run(browser, f"return {own}.map(({{plot}}) => [plot.scales.y.min, plot.scales.y.max])", "speed")
    assert all(each == ranges[0] for each in ranges)
    assert ranges[0][1] > 119


@pytest.mark.parametrize("width", [400, 1000, 1600])
def test_the_values_of_the_cursor_lie_beside_the_plots_and_never_over_the_loops(browser, stop_page, width):
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


def test_labels_lie_above_the_panels_and_not_over_each_other(browser, stop_page):
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    boxes = run(
        browser,
        "return [...document.querySelectorAll('.panels-plot .label-row span')]"
        ".filter((each) => each.textContent)"
        ".map((each) => each.getBoundingClientRect())"
        ".map((box) => [box.left, box.right, box.top, box.bottom])",
    )
    assert len(boxes) >= 8
    for k, first in enumerate(boxes):
        for second in boxes[k + 1 :]:
            assert not _overlap(first, second)


def _overlap(first, second):
    across = first[0] < second[1] - 1 and second[0] < first[1] - 1
    return across and first[2] < second[3] - 2 and second[2] < first[3] - 2


def _choose(browser, within, name, value):
    run(
        browser,
        "const choice = document.querySelector(`${arguments[0]} select[data-choice=${arguments[1]}]`);"
        "choice.value = arguments[2]; choice.dispatchEvent(new Event('change', {bubbles: true}))",
        within,
        name,
        value,
    )


@pytest.mark.parametrize("link", ["#case-slip%20120%5Bfriction%3D0.09%5D", "#case-slip 120[friction=0.09]"])
def test_a_link_to_a_case_opens_it_whichever_way_it_is_encoded(browser, stop_page, link):
    browser.get(stop_page.as_uri())
    run(browser, "document.querySelector('details.stop').open = false; location.hash = arguments[0]", link)
    assert wait(browser, "return document.querySelector('details.stop').open")


def test_the_link_and_the_command_can_be_copied(browser, stop_page):
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


def test_the_samples_behind_the_plots_come_as_csv(browser, stop_page):
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    run(
        browser,
        """
        window.saved = null;
        URL.createObjectURL = (blob) => { blob.text().then((text) => { window.saved = text; }); return '#'; };
        document.querySelector('.tables button').click();
        """,
    )
    text = str(wait(browser, "return window.saved"))
    comments = [line for line in text.splitlines() if line.startswith("#")]
    assert comments[0] == f"# case: {CASE}"
    assert "Sampled every 10 ms" in comments[1]
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    times, slides = (
        np.array([float(row[key] or "nan") for row in rows]) for key in ("time, s", "slide_3, %")
    )
    assert np.diff(times) == pytest.approx(0.01)
    # The train is at rest at the end of the record: a slide is no number there.
    assert np.isnan(slides[-1])
    assert times[np.nanargmax(slides)] == pytest.approx(8.0)
    assert np.nanmax(slides) == pytest.approx(60.0, abs=0.05)
    assert {"fill", "vent"} <= {row["valve_command_1"] for row in rows}


def test_the_upright_axes_follow_what_is_in_view_and_the_loops_show_that_part(browser, stop_page):
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    highest = (
        "return document.querySelector('.panels-plot').plots"
        ".find(({row}) => row.key === 'slide').plot.scales.y.max"
    )
    assert run(browser, highest) > 60
    run(browser, "document.querySelector('.panels-plot').plots[0].plot.setScale('x', {min: 1, max: 7.5})")
    assert wait(browser, f"const most = () => {{{highest}}}; return most() < 50")
    ends = "return document.querySelector('.panels-plot').plots.map(({plot}) => plot.scales.x.max)"
    assert set(run(browser, ends)) == {7.5}
    run(browser, "document.querySelector('.zoom button[value=all]').click()")
    assert wait(browser, f"const most = () => {{{highest}}}; return most() > 60")


@pytest.mark.parametrize(("across", "unit"), [("distance", "m"), ("speed", "km/h")])
def test_the_plots_stand_over_distance_and_over_the_speed_of_the_train(browser, stop_page, across, unit):
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    _choose(browser, ".plots", "across", across)
    slider = browser.find_element("css selector", ".readout input")
    step_to(browser, slider, 294)  # 10 s of 34 s
    place, title = run(
        browser,
        "const {plot} = document.querySelector('.panels-plot').plots[0];"
        "const line = plot.over.querySelector('.cursor-line');"
        "const foot = document.querySelector('.panels-plot').plots.at(-1).plot;"
        "return [plot.posToVal(parseFloat(line.style.left), 'x'), foot.axes[0].label]",
    )
    assert title.endswith(unit)
    # 120 km/h, 1 m/s2 from the command on; over speed, a place is its negative.
    expected = {"distance": 10.0 * 120.0 / 3.6 - 0.5 * 10.0**2, "speed": -(120.0 - 36.0)}[across]
    assert place == pytest.approx(expected, rel=0.01)


def test_two_cursors_read_the_difference_the_mean_and_the_vents_between(browser, stop_page):
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    slider = browser.find_element("css selector", ".readout input")
    step_to(browser, slider, 294)
    browser.find_element("css selector", ".pin").click()
    step_to(browser, slider, 441)  # 5 s more
    assert browser.find_element("css selector", ".between output").text == "5.00 s from 10.00 s"
    train = "return document.querySelector('.train-readout dd').textContent"
    assert run(browser, train) == "-18.0"
    _choose(browser, ".plots", "reading", "mean")
    assert run(browser, train) == "75.0"
    _choose(browser, ".plots", "reading", "value")
    assert run(browser, train) == "66.0"
    browser.find_element("css selector", ".unpin").click()
    assert not browser.find_element("css selector", ".between").is_displayed()


def test_the_loops_are_those_of_the_wheelset_that_is_chosen(browser, stop_page):
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    titles = (
        "return [...document.querySelectorAll('.loops-plot .plot-title')].map((each) => each.textContent)"
    )
    loops = ("Clamping force over tank pressure", "Adhesion over slide")
    assert run(browser, titles) == [f"{loop}, wheelset 3" for loop in loops]  # it decides what was missed
    _choose(browser, ".plots", "wheelset", "1")
    assert run(browser, titles) == [f"{loop}, wheelset 1" for loop in loops]


def test_on_a_phone_case_verdict_and_measures_are_in_sight(browser, stop_page):
    resize(browser, 400)
    browser.get(stop_page.as_uri())
    script = """
      const cells = [...document.querySelectorAll('.verdicts tbody tr:first-child > *')];
      return cells.map((cell) => cell.getBoundingClientRect()).map(({left, right}) => [left, right]);
    """
    ends = run(browser, script)
    assert len(ends) >= 10
    assert all(left >= 0 and right <= 400 for left, right in ends)


def test_on_a_narrow_phone_every_panel_has_its_whole_title_and_nothing_overflows(browser, tmp_path):
    recording = make_recording()
    some = recording["slide_1"]
    own = {f"{name}_{n}": (unit, 0.2 + some) for n in (1, 2, 3, 4) for name, unit in _FURTHER.items()} | {
        "track_brake_force": ("N", 4e4 + some)
    }
    channels = {name: values for name, (_, values) in own.items()}
    units = {name: unit for name, (unit, _) in own.items()}
    recording = replace(
        recording, channels={**recording.channels, **channels}, units={**recording.units, **units}
    )
    result = make_result(id="dry-120")
    page = written(tmp_path, make_content(result, traces={"dry-120": trace_of(recording)}))
    resize(browser, 360)
    browser.get(f"{page.as_uri()}#case-dry-120")
    wait(browser, PLOTTED)
    titles = run(
        browser, "return [...document.querySelectorAll('.plot-title')].map((each) => each.textContent)"
    )
    panels = [panel.title for panel in PANELS]
    assert [title for title in panels if not any(each.startswith(title) for each in titles)] == []
    assert [title for title in titles if title.endswith("…")] == []
    assert run(browser, "return document.documentElement.scrollWidth") <= 360


def test_paper_has_the_name_of_the_run_and_the_numbers_of_its_pages(browser, stop_page):
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


def test_lines_of_a_panel_are_told_apart_without_colours(browser, stop_page):
    """By dash or width, and so are the samples of the key; a dotted line belongs to the one above it."""
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    panels = run(
        browser,
        "return document.querySelector('.panels-plot').plots.map(({lines}) =>"
        " lines.map((each) => `${each.dash} ${each.width}`).filter((style) => !style.startsWith('1,2 ')))",
    )
    key = run(
        browser,
        "return [...document.querySelectorAll('details.stop .key .line')].map((each) => {"
        " const {strokeDasharray, strokeWidth} = getComputedStyle(each);"
        " return `${strokeDasharray} ${strokeWidth}`; })",
    )
    assert max(map(len, panels)) >= 5
    assert len(key) == 8
    assert all(len(set(styles)) == len(styles) for styles in [*panels, key])


def test_the_band_of_the_repeats_lies_behind_the_lines_over_time_alone(browser, tmp_path):
    recording = make_recording()
    extremes = [
        stop_extremes(
            replace(recording, channels={**recording.channels, "speed": recording["speed"] - slower})
        )
        for slower in (0.0, 5.0 / 3.6, 2.0 / 3.6)
    ]
    stops = tuple(RepeatedStop(seed, "pass", "", (make_verdict(),)) for seed in range(3))
    result = make_result(id=CASE, repeats=Repeats("all", stops))
    trace = with_band(trace_of(recording), extremes)
    browser.get(written(tmp_path, make_content(result, traces={CASE: trace})).as_uri())
    wait(browser, READY)
    bands = "return document.querySelector('.panels-plot').plots.map(({bands}) => bands.length)"
    assert [count for count in run(browser, bands) if count] == [5, 4]
    span = run(
        browser,
        """
        const {plot, bands, data: [x]} = document.querySelector('.panels-plot').plots[0];
        const row = x.findIndex((time) => Math.abs(time - 10) < 1e-3);
        const train = bands.findIndex(({ink}) => ink === 'train');
        const [lower, upper] = [1, 2].map((edge) => plot.data[2 * train + edge]);
        return [lower[row], upper[row], plot.series.length, plot.data.length];
        """,
    )
    assert span[:2] == pytest.approx([120.0 - 36.0 - 5.0 - 0.18, 120.0 - 36.0 + 0.18], abs=0.05)
    assert span[2] == span[3]
    box = "document.querySelector('[data-role=band]')"
    run(browser, f"{box}.click()")
    assert sum(run(browser, bands)) == 0
    run(browser, f"{box}.click()")
    choice = "const over = document.querySelector('[data-choice=across]'); over.value = arguments[0];"
    for over, count in (("distance", 0), ("time", 9)):
        run(browser, f"{choice} over.dispatchEvent(new Event('change', {{bubbles: true}}))", over)
        assert sum(run(browser, bands)) == count
        assert run(browser, f"return {box}.disabled") == (count == 0)


def test_cursors_and_labels_stand_at_their_instants_after_a_zoom(browser, stop_page):
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    slider = browser.find_element("css selector", ".readout input")
    step_to(browser, slider, 235)  # 8 s of 34 s
    offsets = """
        const {plot} = document.querySelector('.panels-plot').plots.find(({row}) => row.key === 'slide');
        const line = plot.over.querySelector('.cursor-line');
        const label = [...document.querySelectorAll('.label-row span')].find(
          ({textContent}) => textContent.startsWith('3: 60'));
        const {min, max} = plot.scales.x;
        return [min <= 8 && max >= 8, ...[line, label].map(
          (each) => each && !each.hidden && parseFloat(each.style.left) - plot.valToPos(8, 'x'))];
    """
    settled = "const done = arguments[arguments.length - 1]; requestAnimationFrame(() => setTimeout(done))"
    found = []
    for button in ("in", "on", "back", "back", "in", "all"):
        run(browser, f"document.querySelector('.zoom button[value={button}]').click()")
        browser.execute_async_script(settled)
        found.append(run(browser, offsets))
    assert [seen for seen, *_ in found] == [False, False, False, True, False, True]
    at_its_instant = pytest.approx(0.0, abs=0.6)
    for seen, line, label in found:
        assert (line, label) == ((at_its_instant, at_its_instant) if seen else (False, None))
