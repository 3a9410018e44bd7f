"""Faults in a scenario: when they are, what they take, and what is wrong with them."""

import pytest

from uictest.judging.evaluation import effective_parts

SILENT = "part: controller, kind: silent, "
ON_2 = "at: 3 s, wheelset: 2, "
SENSOR = ON_2 + "part: speed-sensor, "
STUCK = "{at: 3 s, wheelset: 2, part: speed-sensor, kind: stuck}"


def test_an_instant_is_a_time_a_speed_or_a_distance(head, loaded):
    for text, value, unit in (("3 s", 3.0, "s"), ("90 km/h", 25.0, "m/s"), ("0.12 km", 120.0, "m")):
        [case] = loaded(f"{head}faults: [{{at: {text}, part: controller, kind: silent}}]\n")
        [fault] = case.scenario.faults
        assert (float(fault.at), fault.at.unit, fault.until) == (pytest.approx(value), unit, None)


@pytest.mark.parametrize(
    ("fault", "key", "message", "hint"),
    [
        (SILENT + "at: 3", "at", "no instant of a stop", "3 s, 90 km/h, 120 m"),
        (SILENT + "at: 3 bar", "at", "no instant of a stop", "3 s"),
        (SILENT + "at: 200 km/h", "at", "never runs at 200 km/h", "at: 0 s"),
        (SILENT + "at: 3 s, until: 3 s", "until", "before it begins", "above `at`"),
        (SILENT + "at: 60 km/h, until: 80 km/h", "until", "before it begins", "below `at`"),
        (SILENT + "at: 3 s, wheelset: 1", "wheelset", "has one 'controller'", "leave"),
        (ON_2 + "part: speed-senser, kind: stuck", "part", "unknown part", "'speed-sensor'"),
        (ON_2 + "part: speed-sensor, kind: shorted", "kind", "has no fault 'shorted'", "missing-teeth"),
        (ON_2 + "part: hold-magnet, kind: shorted, value: 2 s", "value", "takes no value", "leave"),
        ("at: 3 s, part: speed-sensor, kind: stuck", "", "is not said", "wheelset: 1"),
        ("at: 3 s, wheelset: 5, part: speed-sensor, kind: stuck", "wheelset", "at most 4", ""),
        (SENSOR + "kind: offset", "", "needs a value", "200 km/h"),
        (SENSOR + "kind: offset, value: 300 km/h", "value", "out of range", "at most 200 km/h"),
        (SENSOR + "kind: offset, value: 20 %", "value", "unknown unit", "km/h"),
        (SENSOR + "kind: missing-teeth, value: 2", "kind", "counts no teeth", "whole-teeth"),
    ],
)
def test_what_is_wrong_is_said_at_its_key(head, refused, fault, key, message, hint):
    [diagnostic] = refused(f"{head}faults: [{{{fault}}}]\n")
    assert diagnostic.key == ("faults.0" if not key else f"faults.0.{key}")
    assert message in diagnostic.message
    assert hint in diagnostic.hint


def test_lists_of_faults_name_their_cases_and_keys_inside_a_fault_vary(head, loaded):
    lost = "{at: 90 km/h, part: speed-sensor, kind: lost, wheelset: 1, until: 8 s, value: 5 km/h}"
    cases = loaded(f"{head}matrix: {{faults: [[], [{STUCK}], [{STUCK}, {lost}]]}}\n")
    assert [case.id for case in cases] == [
        "stop[faults=none]",
        "stop[faults=speed-sensor-stuck-2-3s]",
        "stop[faults=speed-sensor-stuck-2-3s+speed-sensor-lost-5kmh-1-90kmh-8s]",
    ]
    axes = "faults.0.at: [3 s, 60 km/h], faults.0.wheelset: [1, 2]"
    cases = loaded(f"{head}faults: [{STUCK}]\nmatrix: {{{axes}}}\n")
    found = [(case.scenario.faults[0].at.text, case.scenario.faults[0].wheelset) for case in cases]
    assert found == [("3 s", 1), ("3 s", 2), ("60 km/h", 1), ("60 km/h", 2)]
    [case] = loaded(f"{head}faults: [{STUCK}]\n", "faults.0.kind=lost")
    assert case.scenario.faults[0].label == "speed-sensor-lost-2"


def test_what_no_list_and_no_pole_wheel_can_hold_is_refused(head, refused, loaded):
    [diagnostic] = refused(f"{head}faults: [{STUCK}]\nmatrix: {{faults.1.at: [3 s]}}\n")
    assert diagnostic.message == "'faults' is a list of one entry, 0; '1' is none"
    assert loaded(f"{head}faults: [{', '.join([STUCK] * 8)}]\n")
    [diagnostic] = refused(f"{head}faults: [{', '.join([STUCK] * 9)}]\n")
    assert "at most 8" in diagnostic.message
    sensor = "rig: {sensors: {extends: pole-wheel, speed: {teeth: 60, missing_teeth: 5}}}\n"
    fault = "{at: 3 s, wheelset: 2, part: speed-sensor, kind: missing-teeth, value: 55}"
    [diagnostic] = refused(f"{head}{sensor}faults: [{fault}]\n")
    assert diagnostic.message == "55 and 5 of 60 teeth: at least one must be left"


def test_effective_parameters_list_the_faults(head, loaded):
    [with_fault] = loaded(f"{head}faults: [{STUCK}]\n")
    [without] = loaded(head)
    keys = [each.key for each in effective_parts(with_fault.scenario)["scenario"].parameters]
    assert [key for key in keys if key.startswith("faults")] == [
        f"faults.0.{name}" for name in ("at", "wheelset", "part", "kind")
    ]
    own = effective_parts(without.scenario)["scenario"].parameters
    assert not any(each.key.startswith("faults") for each in own)
