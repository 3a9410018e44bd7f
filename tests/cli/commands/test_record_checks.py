"""Records that contradict their scenario, on the command line and in every report."""

import csv
import json
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

RASTER = 0.1


@pytest.fixture(name="coasting")
def _coasting(workplace):
    """Write a stop of rolling wheels at 1 m/s2 from a speed in km/h, the brake command at 2 s."""

    def write(speed, name):
        time = np.arange(0.0, 60.0, 0.02)
        train = np.clip(speed / 3.6 - np.clip(time - 2.0, 0.0, None), 0.0, None)
        columns = {"speed": train, **{f"wheel_speed_{n}": train for n in (1, 2, 3, 4)}}
        head = ",".join(["time [s]", *(f"{each} [m/s]" for each in columns)])
        np.savetxt(
            workplace / name,
            np.column_stack((time, *columns.values())),
            "%.6g",
            ",",
            header=head,
            comments="",
        )
        return workplace / name

    return write


@pytest.mark.parametrize("speed", [124, 100, 116.9])
def test_a_stop_from_another_speed_never_passes_as_the_test(call, coasting, speed):
    answer = call("evaluate", coasting(speed, "a.csv"), "--scenario", "slip-120", "--trigger", "2 s", code=1)
    assert "outcome=invalid" in answer.out
    assert f"recorded {speed:.4g} km/h, scenario slip-120 says 120 km/h, tolerance 3 km/h" in answer.out


def test_every_report_has_the_layer_and_both_numbers(call, coasting):
    call("evaluate", coasting(124, "a.csv"), "--scenario", "slip-120", "--trigger", "2 s", code=1)
    reason = "recorded 124 km/h, scenario slip-120 says 120 km/h, tolerance 3 km/h"
    folder = Path("reports/latest")
    rows = list(csv.DictReader((folder / "criteria.csv").read_text("utf-8").splitlines()))
    [row] = [each for each in rows if each["criterion"] == "record-initial-speed"]
    assert (row["layer"], row["verdict"], row["reason"]) == ("record", "fail", reason)
    results = json.loads((folder / "results.json").read_text("utf-8"))
    [verdict] = [each for each in results["cases"][0]["criteria"] if each["id"] == "record-initial-speed"]
    assert (verdict["layer"], verdict["upper"]) == ("record", 3.0)
    assert verdict["value"] == pytest.approx(4.0, abs=0.001)
    assert verdict["definition"]["bound"] == "<= 3 km/h (chosen)"
    failures = ElementTree.parse(folder / "junit.xml").iter("failure")
    assert any(reason in f"{each.get('message')} {each.text}" for each in failures)
    page = (folder / "index.html").read_text("utf-8")
    assert reason in page
    assert "the record agrees with its scenario (record)" in page
    call("report", "reports/latest", "--format", "html", "-o", "again")
    assert reason in Path("again/index.html").read_text("utf-8")


def test_the_checks_that_hold_are_one_sentence_with_those_that_were_not_made(call, coasting):
    arguments = "evaluate", coasting(120, "a.csv"), "--scenario", "dry-120", "--trigger", "2 s"
    answer = call(*arguments, "-v")
    assert "checks of the record: all hold, 3 not made" in answer.err + answer.out
    assert "Checks of the record: all hold, 3 not made." in Path("reports/latest/index.html").read_text(
        "utf-8"
    )


def test_a_log_of_other_speeds_passes_no_stop_and_says_how_many(call, workplace):
    """As a log of public buses, 27 stops from 24 to 57 km/h, judged as a slip test from 120 km/h."""
    speeds = np.linspace(24.0, 57.0, 27) / 3.6
    courses = [(np.full(100, v), np.linspace(v, 0.0, round(v / RASTER)), np.zeros(50)) for v in speeds]
    brake = [np.repeat((0.0, 1.0, 0.0), list(map(len, course))) for course in courses]
    speed = np.concatenate([part for course in courses for part in course])
    columns = {f"{name} [m/s]": speed for name in ("speed", *(f"wheel_speed_{n}" for n in (1, 2, 3, 4)))}
    table = {"time [s]": RASTER * np.arange(len(speed)), **columns, "brake_command": np.concatenate(brake)}
    np.savetxt(
        workplace / "bus.csv",
        np.column_stack(list(table.values())),
        "%.6g",
        ",",
        header=",".join(table),
        comments="",
    )
    answer = call("log", "bus.csv", "--scenario", "slip-120", code=1)
    assert "invalid by the record: 27 of 27 stops (record-initial-speed 27)" in answer.out
    assert "27 cases: 27 invalid" in answer.err
    wide = ("--set", "record.tolerances.initial_speed=100 km/h")
    answer = call("log", "bus.csv", "--scenario", "slip-120", *wide)
    assert "by the record" not in answer.out
    stated = ("rail.condition=dry", "brake.position=R", "rig.wsp=active", "criteria=uictest-stop")
    answer = call("log", "bus.csv", *(word for each in stated for word in ("--set", each)), code=0)
    assert "27 cases: 27 pass" in answer.err
