"""Links of a page in a browser end, at the first click, with what they name on the screen."""

from dataclasses import replace

import numpy as np
import pytest

from uictest.judging.evaluation import AppliedDefinition
from uictest.report.traces.trace import trace_of

from .builders import make_content, make_recording, make_result, make_verdict
from .chromium import resize, run, wait, written

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
    recording = replace(recording, channels={**recording.channels, "wheel_speed_2": locked})
    speeds = {"low_speed_cutoff": 8.33, "moving_speed": 2.78, "locked_speed": 0.1}
    own = {
        "definitions": tuple(AppliedDefinition(name, size, "m/s", "stated") for name, size in speeds.items()),
        "status": "fail",
        "lower": None,
    }
    slide = {"measure": "maximum_slide_above_cutoff", "value": 40.0, "unit": "%", "upper": 35.0}
    lock = {"measure": "longest_lock", "value": 2.0, "unit": "s", "upper": 1.0}
    criteria = (
        make_verdict(id="largest-slide", margin=-5.0, **slide, **own),
        make_verdict(id="lock", margin=-1.0, missed_by=(2,), **lock, **own),
    )
    results = [make_result(id=f"stop-{n}", outcome="fail", criteria=criteria) for n in range(4)]
    traces = {each.id: trace_of(recording, each.criteria) for each in results}
    return written(tmp_path_factory.mktemp("page"), make_content(*results, traces=traces))


@pytest.mark.parametrize("number", range(0, 12, 2))
def test_a_link_ends_with_the_name_of_the_stop_and_the_lit_plot_on_the_screen(browser, four_stops, number):
    resize(browser, 1240)
    browser.get(four_stops.as_uri())
    links = browser.find_elements("css selector", ".findings li a")
    assert len(links) == 12
    links[number].click()
    to_instant = links[number].text.startswith("at ")
    found = wait(browser, WHERE, to_instant)
    assert found == [f"case-stop-{number // 3}", True, True if to_instant else None]


def test_the_cursor_shows_the_first_sample_of_a_lock(browser, four_stops):
    browser.get(four_stops.as_uri())
    browser.find_element("css selector", '.findings a[data-criterion="lock"]').click()
    wait(browser, "return document.querySelector('button.moment[aria-pressed=true]') !== null")
    speeds = browser.find_element("css selector", ".readout tbody tr").text.split()
    assert speeds[-3] == "0.0"
    chosen = "return document.querySelector('.loops [data-choice=\"wheelset\"]').value"
    assert run(browser, chosen) == "2"


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
