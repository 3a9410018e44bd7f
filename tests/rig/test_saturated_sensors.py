"""Sensors that are limited by their range: counted while they are, and named."""

import re

import numpy as np
import pytest

from uictest.running.campaign import RecordingRequest, Stop, run_stop


def judged(rig, *overrides, **ranges):
    """A judged stop whose sensors of a kind have a range."""
    sensors = [f"rig.sensors.{kind}.range={limit}" for kind, limit in ranges.items()]
    return run_stop(
        Stop(rig.case("initial_speed=60 km/h", *overrides, *sensors)), RecordingRequest("all", 0.01)
    ).case_run


def check(run, name):
    return next(each for each in run.result.criteria if each.id == name)


@pytest.mark.parametrize(
    ("topology", "named"), [("one-caliper", ["1"]), ("four-caliper", ["1", "2", "3", "4"])]
)
def test_loadcells_that_show_less_than_there_is_make_a_stop_invalid(rig, topology, named):
    """The train brakes with what they show; the time is that of the recording."""
    run = judged(rig, f"rig.topology={topology}", loadcell="12 kN")
    verdict = check(run, "loadcells-in-range")
    assert (run.result.outcome, verdict.status) == ("invalid", "fail")
    assert [n for n in "1234" if f"loadcells of wheelset {n} limited to 12 kN" in verdict.reason] == named
    force = run.recording["clamping_force_1"]
    first = float(run.recording["time"][np.argmax(force >= 11.99e3)])
    [told] = re.findall(r"the first by ([0-9.]+) s", verdict.reason)
    assert float(told) == pytest.approx(first, abs=0.02)
    limited = 0.01 * float(np.sum(force >= 11.99e3)) * len(named)
    assert verdict.value == pytest.approx(limited, abs=0.05 * len(named))
    assert check(run, "pressure-sensors-in-range").status == "pass"


def test_pressure_sensors_at_their_range_are_named_that_of_the_brake_line_too(rig):
    run = judged(rig, pressure="3 bar")
    reason = check(run, "pressure-sensors-in-range").reason
    assert run.result.outcome == "invalid"
    for place in ("wheelset 1", "wheelset 4", "the brake line"):
        assert f"pressure sensor of {place} limited to 3 bar for" in reason


def test_the_first_sensor_is_said_to_be_of_any_kind_where_both_are_limited(rig):
    """One time is kept for all sensors; here it is not that of the loadcells, which follow."""
    run = judged(rig, loadcell="14 kN", pressure="1 bar")
    for name in ("loadcells-in-range", "pressure-sensors-in-range"):
        assert "; the first of any kind by " in check(run, name).reason


def test_a_stop_within_the_ranges_has_its_checks_hold(rig):
    run = judged(rig)
    assert {each.status for each in run.result.criteria if each.layer == "rig"} == {"pass"}
