"""Records that contradict their scenario, on the command line and in every report."""

import json
from pathlib import Path

import numpy as np
import pytest

from ..conftest import STATED

RASTER = 0.1
REASON = "recorded 124 km/h, scenario slip-120 says 120 km/h, tolerance 3 km/h"


def write(name, time, speed, **more):
    """Write the record of a train of rolling wheels."""
    names = ("speed", *(f"wheel_speed_{n}" for n in (1, 2, 3, 4)))
    table = {"time [s]": time, **{f"{channel} [m/s]": speed for channel in names}, **more}
    samples = np.column_stack(list(table.values()))
    np.savetxt(name, samples, "%.6g", ",", header=",".join(table), comments="")


@pytest.fixture
def judge(call):
    """Judge a stop at 1 m/s2 from a speed in km/h, the brake command at 2 s, by a scenario."""

    def run(speed, scenario, *options, **expected):
        time = np.arange(0.0, 60.0, 0.02)
        write("a.csv", time, np.clip(speed / 3.6 - np.clip(time - 2.0, 0.0, None), 0.0, None))
        return call("evaluate", "a.csv", "--scenario", scenario, "--trigger", "2 s", *options, **expected)

    return run


@pytest.mark.parametrize("speed", [124, 100, 116.9])
def test_a_stop_from_another_speed_never_passes_as_the_test(judge, speed):
    answer = judge(speed, "slip-120", code=1)
    assert "outcome=invalid" in answer.out
    assert f"recorded {speed:.4g} km/h, scenario slip-120 says 120 km/h, tolerance 3 km/h" in answer.out


def test_every_report_has_the_layer_and_both_numbers(call, judge):
    judge(124, "slip-120", code=1)
    call("report", "reports/latest", "--format", "html", "-o", "again")
    folder = Path("reports/latest")
    for path in (
        folder / "criteria.csv",
        folder / "junit.xml",
        folder / "index.html",
        Path("again/index.html"),
    ):
        assert REASON in path.read_text("utf-8"), path
    results = json.loads((folder / "results.json").read_text("utf-8"))
    [verdict] = [each for each in results["cases"][0]["criteria"] if each["id"] == "record-initial-speed"]
    assert (verdict["layer"], verdict["upper"]) == ("record", 3.0)
    assert verdict["value"] == pytest.approx(4.0, abs=0.001)
    assert verdict["definition"]["bound"] == "<= 3 km/h (chosen)"
    assert "the record agrees with its scenario (record)" in (folder / "index.html").read_text("utf-8")


def test_the_checks_that_hold_are_one_sentence_with_those_that_were_not_made(judge):
    assert "checks of the record: all hold, 3 not made" in judge(120, "dry-120", "-v").out
    page = Path("reports/latest/index.html").read_text("utf-8")
    assert "Checks of the record: all hold, 3 not made." in page


def test_a_log_of_other_speeds_passes_no_stop_and_says_how_many(call):
    """As a log of public buses, 27 stops from 24 to 57 km/h, judged as a slip test from 120 km/h."""
    speeds = np.linspace(24.0, 57.0, 27) / 3.6
    courses = [(np.full(100, v), np.linspace(v, 0.0, round(v / RASTER)), np.zeros(50)) for v in speeds]
    brake = np.concatenate([np.repeat((0.0, 1.0, 0.0), list(map(len, course))) for course in courses])
    speed = np.concatenate([part for course in courses for part in course])
    write("bus.csv", RASTER * np.arange(len(speed)), speed, brake_command=brake)
    answer = call("log", "bus.csv", "--scenario", "slip-120", code=1, says="27 cases: 27 invalid")
    assert "invalid by the record: 27 of 27 stops (record-initial-speed 27)" in answer.out
    wide = ("--set", "record.tolerances.initial_speed=100 km/h")
    assert "by the record" not in call("log", "bus.csv", "--scenario", "slip-120", *wide).out
    call("log", "bus.csv", *STATED, code=0, says="27 cases: 27 pass")
