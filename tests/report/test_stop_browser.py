"""One stop on a page in a browser: where values were taken, links, commands, points of the plots."""

from dataclasses import replace

import numpy as np
import pytest

from uictest.judging.evaluation import AppliedDefinition, RepeatedStop, Repeats
from uictest.report import RunManifest
from uictest.report.traces.quantities import PANELS
from uictest.report.traces.trace import stop_extremes, trace_of, with_band

from .builders import make_content, make_recording, make_result, make_verdict
from .chromium import (
    PLOTTED,
    READY,
    by_head,
    choose,
    click,
    emulate,
    resize,
    run,
    saved,
    step_to,
    texts,
    wait,
    written,
)

CASE = "slip 120[friction=0.09]"


def _definitions(**speeds):
    return tuple(AppliedDefinition(name, speed / 3.6, "m/s", "stated") for name, speed in speeds.items())


def _with(recording, unit="1", **channels):
    units = {**recording.units, **dict.fromkeys(channels, unit)}
    return replace(recording, channels={**recording.channels, **channels}, units=units)


@pytest.fixture(scope="module")
def stop_page(tmp_path_factory):
    """A stop whose wheelset 3 has the largest slide above the cut-off, 60 % at 8 s; 35 % are allowed."""
    recording = make_recording(sliding_time="5.0")
    largest = np.where(np.isclose(recording["time"], 8.0), 0.6, recording["slide_3"])
    recording = _with(recording, slide_3=largest, wheel_speed_3=recording["speed"] * (1.0 - largest))
    slide = make_verdict(
        id="largest-slide", measure="maximum_slide_above_cutoff", value=60.0, unit="%",
        lower=None, upper=35.0, margin=-25.0, status="fail",
        definitions=_definitions(low_speed_cutoff=30.0, moving_speed=10.0),
    )  # fmt: skip
    result = make_result(
        id=CASE, scenario="scenarios/slip.yaml", outcome="fail", criteria=(make_verdict(), slide)
    )
    manifest = RunManifest(command=("uictest", "run", "scenarios", "--set", "rail.friction=0.09", "-n", "2"))
    traces = {CASE: trace_of(recording, result.criteria)}
    return written(tmp_path_factory.mktemp("page"), make_content(result, manifest=manifest, traces=traces))


@pytest.fixture
def stop(browser, stop_page):
    """The browser, in which the plots of that stop answer."""
    browser.get(stop_page.as_uri())
    wait(browser, READY)
    return browser


def _plots(rest, key=""):
    """Return a script that returns something of the plots of a stop, or of those of a row."""
    chosen = f".filter(({{row}}) => row.key === '{key}')" if key else ""
    return f"return document.querySelector('details.stop[open] .panels-plot').plots{chosen}{rest}"


def test_a_criterion_leads_to_the_instant_at_which_its_value_was_taken(stop):
    assert [text.split()[0] for text in texts(stop, "table.margins tbody th")] == [
        "largest-slide",
        "braking-distance",
    ]
    button = stop.find_element("css selector", "button.moment")
    assert button.text == "8 s, wheelset 3"
    button.send_keys("\ue007")
    assert stop.find_element("css selector", ".readout output").text == "8.00 s"
    assert button.get_attribute("aria-pressed") == "true"
    ring, place = run(
        stop,
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
    assert not stop.find_element("css selector", ".ring").is_displayed()


def test_what_failed_leads_from_the_top_of_the_page_to_its_instant_and_so_does_a_vent(stop):
    link = stop.find_element("css selector", ".group a[data-criterion]")
    assert link.text.endswith("wheelset 3, 8 s")
    run(stop, "document.querySelector('details.stop').open = false")
    link.click()
    assert wait(stop, "return document.querySelector('button.moment[aria-pressed=true]') !== null")
    assert stop.find_element("css selector", ".readout output").text == "8.00 s"
    assert stop.find_element("css selector", ".ring").is_displayed()
    run(stop, "document.querySelector('table.vents').closest('details').open = true")
    button = stop.find_element("css selector", "table.vents tbody tr:nth-child(2) button")
    button.send_keys("\ue007")
    assert stop.find_element("css selector", ".readout output").text == f"{button.text} s"
    assert stop.find_element("css selector", ".spotlight").is_displayed()


def test_the_ring_follows_its_wheelset_where_they_stand_side_by_side(stop):
    stop.find_element("css selector", "button.moment").click()
    choose(stop, "view", "apart")
    assert wait(stop, _plots(".length === 4", "slide"))
    wait(stop, "return document.querySelector('.ring:not([hidden])') !== null")
    shown = ".map(({plot}) => plot.over.querySelector('%s:not([hidden])') !== null)"
    assert run(stop, _plots(shown % ".ring", "slide")) == [False, False, True, False]
    assert run(stop, _plots(shown % ".cursor-line", "slide")) == [True] * 4
    ranges = run(stop, _plots(".map(({plot}) => [plot.scales.y.min, plot.scales.y.max])", "speed"))
    assert all(each == ranges[0] for each in ranges)
    assert ranges[0][1] > 119


@pytest.mark.parametrize("width", [400, 1000, 1600])
def test_nothing_lies_over_anything_else_however_wide_the_window(browser, stop_page, width):
    """Neither the values of the cursor over the loops, nor labels above the panels over each other.

    On a phone, too, case, verdict and measures are in sight.
    """
    resize(browser, width)
    browser.get(stop_page.as_uri())
    cells = """
      const cells = [...document.querySelectorAll('.verdicts tbody tr:first-child > *')];
      return cells.map((cell) => cell.getBoundingClientRect()).map(({left, right}) => [left, right]);
    """
    ends = run(browser, cells)
    assert len(ends) >= 10
    assert all(left >= 0 and right <= width for left, right in ends)
    wait(browser, PLOTTED)
    overlap = """
      document.querySelector('.plots .loops').scrollIntoView({block: 'start', behavior: 'instant'});
      const [a, b] = ['.plots .loops', '.readout'].map((name) =>
        document.querySelector(name).getBoundingClientRect());
      return Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
    """
    assert run(browser, overlap) <= 0
    labels = """
      const boxes = [...document.querySelectorAll('.panels-plot .label-row span')]
        .filter((each) => each.textContent).map((each) => each.getBoundingClientRect());
      return [boxes.length, boxes.flatMap((a, k) => boxes.slice(k + 1).filter((b) => a.left < b.right - 1 &&
        b.left < a.right - 1 && a.top < b.bottom - 2 && b.top < a.bottom - 2)).length];
    """
    count, over_each_other = run(browser, labels)
    assert count >= 8
    assert over_each_other == 0


def test_a_link_to_a_case_opens_it_whichever_way_it_is_encoded_and_can_be_copied(stop, stop_page):
    for link in ("#case-slip%20120%5Bfriction%3D0.09%5D", "#case-slip 120[friction=0.09]"):
        close = "document.querySelector('details.stop').open = false; location.hash = arguments[0]"
        run(stop, f"location.hash = ''; {close}", link)
        assert wait(stop, "return document.querySelector('details.stop').open")
    copied = run(
        stop,
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
    assert wait(stop, "return document.querySelector('.stop .copied').textContent") == "Copied command."


def test_the_samples_behind_the_plots_come_as_csv(stop):
    comments, rows = saved(stop, ".tables button")
    assert comments[0] == f"# case: {CASE}"
    assert "Sampled every 10 ms" in comments[1]
    times, slides = (
        np.array([float(row[key] or "nan") for row in rows]) for key in ("time, s", "slide_3, %")
    )
    assert np.diff(times) == pytest.approx(0.01)
    # The train is at rest at the end of the record: a slide is no number there.
    assert np.isnan(slides[-1])
    assert times[np.nanargmax(slides)] == pytest.approx(8.0)
    assert np.nanmax(slides) == pytest.approx(60.0, abs=0.05)
    assert {"fill", "vent"} <= {row["valve_command_1"] for row in rows}


def test_the_upright_axes_follow_what_is_in_view(stop):
    highest = _plots("[0].plot.scales.y.max", "slide")
    assert run(stop, highest) > 60
    run(stop, _plots("[0].plot.setScale('x', {min: 1, max: 7.5})"))
    assert wait(stop, f"const most = () => {{{highest}}}; return most() < 50")
    assert set(run(stop, _plots(".map(({plot}) => plot.scales.x.max)"))) == {7.5}
    click(stop, ".zoom button[value=all]")
    assert wait(stop, f"const most = () => {{{highest}}}; return most() > 60")


def test_the_plots_stand_over_distance_and_speed_and_their_loops_are_those_of_a_wheelset(stop):
    # 120 km/h, 1 m/s2 from the command on; over speed, a place is its negative.
    expected = {("distance", "m"): 10.0 * 120.0 / 3.6 - 0.5 * 10.0**2, ("speed", "km/h"): -(120.0 - 36.0)}
    for (across, unit), place in expected.items():
        choose(stop, "across", across)
        step_to(stop, stop.find_element("css selector", ".readout input"), 294)  # 10 s of 34 s
        shown, title = run(
            stop,
            "const plots = document.querySelector('.panels-plot').plots; const {plot} = plots[0];"
            "const line = plot.over.querySelector('.cursor-line');"
            "return [plot.posToVal(parseFloat(line.style.left), 'x'), plots.at(-1).plot.axes[0].label]",
        )
        assert title.endswith(unit)
        assert shown == pytest.approx(place, rel=0.01)
    loops = ("Clamping force over tank pressure", "Adhesion over slide")
    titles = ".loops-plot .plot-title"
    assert texts(stop, titles) == [f"{loop}, wheelset 3" for loop in loops]  # it decides what was missed
    choose(stop, "wheelset", "1")
    assert texts(stop, titles) == [f"{loop}, wheelset 1" for loop in loops]


def test_two_cursors_read_the_difference_the_mean_and_the_vents_between(stop):
    slider = stop.find_element("css selector", ".readout input")
    step_to(stop, slider, 294)
    cells = by_head(stop, ".readout tbody tr")
    assert cells["slide, %"] == ["40.0"] * 4
    assert cells["valve command"] == ["vent"] * 4
    click(stop, ".pin")
    step_to(stop, slider, 441)  # 5 s more
    assert stop.find_element("css selector", ".between output").text == "5.00 s from 10.00 s"
    for reading, speed in (("difference", "-18.0"), ("mean", "75.0"), ("value", "66.0")):
        choose(stop, "reading", reading)
        assert texts(stop, ".train-readout dd")[0] == speed
    stop.find_element("css selector", ".unpin").click()
    assert not stop.find_element("css selector", ".between").is_displayed()


def test_on_a_narrow_phone_every_panel_has_its_whole_title_and_nothing_overflows(browser, tmp_path):
    recording = make_recording()
    some = recording["slide_1"]
    units = dict.fromkeys(("dynamic_reduction", "friction", "cleaned_share"), "1")
    units |= {"dynamic_torque": "N m", "sand_density": "kg/m"}
    units |= {"disc_temperature": "K", "disc_surface_temperature": "K"}
    for name, unit in units.items():
        recording = _with(recording, unit, **{f"{name}_{n}": 0.2 + some for n in (1, 2, 3, 4)})
    recording = _with(recording, "N", track_brake_force=4e4 + some)
    result = make_result(id="dry-120")
    page = written(tmp_path, make_content(result, traces={"dry-120": trace_of(recording)}))
    resize(browser, 360)
    browser.get(f"{page.as_uri()}#case-dry-120")
    wait(browser, PLOTTED)
    titles = texts(browser, ".plot-title")
    panels = [panel.title for panel in PANELS]
    assert [title for title in panels if not any(each.startswith(title) for each in titles)] == []
    assert [title for title in titles if title.endswith("…")] == []
    assert run(browser, "return document.documentElement.scrollWidth") <= 360


def test_paper_has_the_drawing_and_no_control_the_name_of_the_run_and_numbers_of_pages(stop):
    emulate(stop, media="print")
    shown = {"svg.panels": True, ".panels-plot": False}
    for selector, displayed in shown.items():
        assert stop.find_element("css selector", f"details[open] {selector}").is_displayed() is displayed
    assert not stop.find_element("css selector", "form.filters").is_displayed()
    rules = run(
        stop,
        "return [...document.styleSheets[0].cssRules].filter((rule) => rule instanceof CSSPageRule)"
        ".map((rule) => rule.cssText).join(' ')",
    )
    assert "a-run" in rules.replace("\\2d ", "-")
    assert "counter(page)" in rules
    head = "return getComputedStyle(document.querySelector('.verdicts thead')).display"
    assert run(stop, head) == "table-header-group"


def test_lines_of_a_panel_are_told_apart_without_colours(stop):
    """By dash or width, and so are the samples of the key; a dotted line belongs to the one above it."""
    styles = "lines.map((each) => `${each.dash} ${each.width}`).filter((style) => !style.startsWith('1,2 '))"
    panels = run(stop, _plots(f".map(({{lines}}) => {styles})"))
    key = run(
        stop,
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
        stop_extremes(_with(recording, "m/s", speed=recording["speed"] - slower / 3.6))
        for slower in (0.0, 5.0, 2.0)
    ]
    stops = tuple(RepeatedStop(seed, "pass", "", (make_verdict(),)) for seed in range(3))
    result = make_result(id=CASE, repeats=Repeats("all", stops))
    trace = with_band(trace_of(recording), extremes)
    browser.get(written(tmp_path, make_content(result, traces={CASE: trace})).as_uri())
    wait(browser, READY)
    bands = _plots(".map(({bands}) => bands.length)")
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
    click(browser, "[data-role=band]")
    assert sum(run(browser, bands)) == 0
    click(browser, "[data-role=band]")
    for over, count in (("distance", 0), ("time", 9)):
        choose(browser, "across", over)
        assert sum(run(browser, bands)) == count
        assert run(browser, "return document.querySelector('[data-role=band]').disabled") == (count == 0)


def test_cursors_and_labels_stand_at_their_instants_after_a_zoom(stop):
    step_to(stop, stop.find_element("css selector", ".readout input"), 235)  # 8 s of 34 s
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
        click(stop, f".zoom button[value={button}]")
        stop.execute_async_script(settled)
        found.append(run(stop, offsets))
    assert [seen for seen, *_ in found] == [False, False, False, True, False, True]
    at_its_instant = pytest.approx(0.0, abs=0.6)
    for seen, line, label in found:
        assert (line, label) == ((at_its_instant, at_its_instant) if seen else (False, None))


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
    vents = "[0].bars.filter(({opacity}) => opacity === 1).flatMap(({spans}) => spans).length"
    assert run(browser, _plots(vents, "valves")) == 320
    run(browser, _plots("[0].plot.setScale('x', {min: 9.95, max: 10.35})"))
    assert wait(browser, _plots("[1].plot.scales.x.max < 11"))
    below_middle = (2 + 0.32 - 0.5) / 4  # of the vent magnet of the second of four rows
    assert _settled(browser, lambda: _inked(browser, "valves", below_middle), 4)


def _settled(browser, read, expected):
    """Return whether what is read of the page becomes what is expected; drawn in some of the next frames."""
    frame = "const done = arguments[arguments.length - 1]; requestAnimationFrame(() => setTimeout(done))"
    for _ in range(200):
        if read() == expected:
            return True
        browser.execute_async_script(frame)
    return False


WHERE = """
const stop = document.getElementById(decodeURIComponent(location.hash.slice(1)));
const near = ({top, bottom}) => bottom > -innerHeight / 2 && top < 1.5 * innerHeight;
const drawn = (plots) => plots.dataset.ready || !(stop.contains(plots) || near(plots.getBoundingClientRect()));
if (!stop || ![...document.querySelectorAll('details.stop[open] .plots')].every(drawn)) return null;
const within = ({top, bottom}) => top >= 0 && bottom <= innerHeight;
const named = within(stop.querySelector('summary h3').getBoundingClientRect());
const pressed = stop.querySelector('button.moment[aria-pressed=true]');
const light = [...stop.querySelectorAll('.spotlight:not([hidden])')].some((each) => within(each.getBoundingClientRect()));
const place = pressed && stop.querySelector('.panels-plot').plots.find(({row}) => row.key === pressed.dataset.plot);
const found = [stop.id, named, place ? within(place.cell.getBoundingClientRect()) && light : null];
return arguments[0] && !place ? null : found;
"""  # noqa: E501 - a script
"""Where a link has led, once what moves the page is drawn: a click may come before the stop that is open from
the beginning is drawn, which then waits, far from the window, to be scrolled to."""


@pytest.fixture(scope="module")
def four_stops(tmp_path_factory):
    """Four stops that miss two criteria each: the largest slide, and a lock of wheelset 2 from 20 s on."""
    recording = make_recording()
    time = recording["time"]
    locked = np.where((time > 20.0) & (time < 22.0), 0.0, recording["wheel_speed_2"])
    recording = _with(recording, "m/s", wheel_speed_2=locked)
    definitions = _definitions(low_speed_cutoff=30.0, moving_speed=10.0, locked_speed=0.36)
    missed = {"definitions": definitions, "status": "fail", "lower": None}
    slide = {"measure": "maximum_slide_above_cutoff", "value": 40.0, "unit": "%", "upper": 35.0}
    lock = {"measure": "longest_lock", "value": 2.0, "unit": "s", "upper": 1.0, "missed_by": (2,)}
    criteria = (
        make_verdict(id="largest-slide", margin=-5.0, **slide, **missed),
        make_verdict(id="lock", margin=-1.0, **lock, **missed),
    )
    results = [make_result(id=f"stop-{n}", outcome="fail", criteria=criteria) for n in range(4)]
    traces = {each.id: trace_of(recording, each.criteria) for each in results}
    return written(tmp_path_factory.mktemp("page"), make_content(*results, traces=traces))


@pytest.mark.parametrize(
    ("link", "number", "to_instant"),
    [
        (".group .tools a", 0, False),
        ('.group a[data-criterion="lock"]', 0, True),
        ('.verdicts a[href="#case-stop-3"]', 3, False),
    ],
)
def test_a_link_ends_with_the_name_of_the_stop_and_the_lit_plot_on_the_screen(
    browser, four_stops, link, number, to_instant
):
    resize(browser, 1240)
    browser.get(four_stops.as_uri())
    browser.find_element("css selector", link).click()
    found = wait(browser, WHERE, to_instant)
    assert found == [f"case-stop-{number}", True, True if to_instant else None]


def test_the_cursor_shows_the_first_sample_of_a_lock(browser, four_stops):
    browser.get(four_stops.as_uri())
    browser.find_element("css selector", '.group a[data-criterion="lock"]').click()
    wait(browser, "return document.querySelector('button.moment[aria-pressed=true]') !== null")
    assert by_head(browser, ".readout tbody tr")["wheelset, km/h"][1] == "0.0"
    chosen = "return document.querySelector('.loops [data-choice=\"wheelset\"]').value"
    assert run(browser, chosen) == "2"
    assert run(browser, _plots("[0].bars.flatMap(({spans}) => spans).length", "locked")) == 1


def test_on_a_phone_verdict_name_and_figures_of_a_stop_keep_apart(browser, four_stops):
    resize(browser, 400)
    browser.get(four_stops.as_uri())
    script = """
      return [...document.querySelectorAll('.stop > summary')].flatMap((summary) => {
        const boxes = [...summary.children].map((each) => each.getBoundingClientRect());
        return boxes.flatMap((one, k) => boxes.slice(k + 1).filter((other) => one.left < other.right - 1 &&
          other.left < one.right - 1 && one.top < other.bottom - 1 && other.top < one.bottom - 1));
      }).length + Math.max(0, document.documentElement.scrollWidth - 400);
    """
    assert run(browser, script) == 0
