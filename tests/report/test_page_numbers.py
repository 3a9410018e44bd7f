"""The numbers of a page in a browser against the results and the recording that it was made from."""

import json
import re
from xml.etree import ElementTree

import numpy as np
import pytest

from uictest.cli.entry import execute
from uictest.core.recording import read_parquet

from .chromium import READY, by_head, run, texts, wait

SCALES = {"km/h": 1 / 3.6, "%": 0.01, "bar": 1e5, "kN": 1e3, "m": 1.0, "1": 1.0}
ROWS = {
    "wheelset, km/h": "wheel_speed",
    "slide, %": "slide",
    "tank, bar": "tank_pressure",
    "cylinder, bar": "cylinder_pressure",
    "clamping force, kN": "clamping_force",
    "adhesion": "adhesion",
}
TRAIN = {
    "train, km/h": "speed",
    "distance, m": "distance",
    "brake line, bar": "brake_line_pressure",
    "reservoir, bar": "reservoir_pressure",
}


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """The folder of a run of one stop that misses a criterion, with its recording."""
    output = tmp_path_factory.mktemp("run")
    words = ["run", "low-adhesion-80", "--set", "expect=pass", "--record", "all", "-o", str(output), "-q"]
    assert execute(words) == 1
    return (output / "latest").resolve()


@pytest.fixture(scope="module")
def recording(finished):
    """The recording of the stop."""
    return read_parquet(finished / "recordings" / "low-adhesion-80.parquet")


@pytest.fixture(scope="module")
def result(finished):
    """The result of the stop."""
    (case,) = json.loads((finished / "results.json").read_text("utf-8"))["cases"]
    return case


def test_junit_says_when_the_value_was_taken_as_the_page_does(finished):
    (case,) = ElementTree.parse(finished / "junit.xml").iter("testcase")
    (instant,) = re.findall(r"total-locked-time .*\(taken at (.*)\)", "".join(case.itertext()))
    assert re.fullmatch(r"[\d.]+ to [\d.]+ s, wheelset [1-4]", instant)
    assert instant in (finished / "index.html").read_text("utf-8")


def test_a_report_that_draws_no_stop_names_no_instant(finished, tmp_path):
    assert execute(["report", str(finished), "--format", "junit", "-o", str(tmp_path)]) == 0
    written = (tmp_path / "junit.xml").read_text("utf-8")
    assert "total-locked-time" in written
    assert "taken at" not in written


@pytest.fixture
def stop(browser, finished):
    """The browser, in which the plots of the stop answer."""
    browser.get((finished / "index.html").as_uri())
    run(browser, "document.querySelector('details.stop').open = true")
    run(browser, "document.querySelector('details.stop .plots').scrollIntoView()")  # drawn when it comes near
    wait(browser, READY)
    return browser


def test_the_cursor_reads_what_was_recorded(stop, recording):
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
                assert float(shown) == pytest.approx(expected, abs=0.61 * last_digit), f"{name} at {at} s"
                compared += 1
    assert compared == 6 * 28


def test_every_vent_of_the_counters_is_in_the_table_and_in_the_plots(stop, result):
    counted = [wheelset["valve_actuations"] for wheelset in result["wheelsets"]]
    numbers = texts(stop, ".vents tbody td:nth-child(2)")
    assert [numbers.count(str(n)) for n in (1, 2, 3, 4)] == counted
    spans = run(
        stop,
        "return document.querySelector('.panels-plot').plots.find(({row}) => row.key === 'valves').bars"
        ".filter(({opacity}) => opacity === 1).map(({spans}) => spans.length)",
    )
    assert spans == counted


def test_values_and_margins_are_those_of_the_result(stop, result):
    shown = run(
        stop,
        "return Object.fromEntries([...document.querySelectorAll('table.margins tbody tr')].map((row) =>"
        " [row.querySelector('th').firstChild.data.trim(), row.textContent]))",
    )
    judged = [each for each in result["criteria"] if each["layer"] != "rig" and each["value"] is not None]
    assert len(judged) >= 4
    for each in judged:
        assert f"{each['value']:.5g}" in shown[each["id"]]
    distance = float(texts(stop, "details.stop .figures dd")[0].split()[0])
    assert distance == pytest.approx(result["measures"]["braking_distance_m"], rel=5e-4)
