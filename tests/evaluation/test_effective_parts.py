"""Every number that a case is run with: whose it is, and whether the library has another."""

import pytest

from uictest.judging.evaluation import effective_parts, parts_document, recorded_parts
from uictest.plans.scenario import load


@pytest.fixture
def cases(tmp_path):
    def write_and_load(text, *overrides):
        path = tmp_path / "stop.yaml"
        path.write_text(f"schema: uictest/scenario/1\nname: stop\ninitial_speed: 80 km/h\n{text}")
        return load([path], overrides)

    return write_and_load


def of(case):
    return effective_parts(case.scenario)


def changed(parts):
    found = (each for part in parts.values() for each in part.changed)
    return {each.key: (each.written, each.library_written) for each in found}


def parameters(parts):
    return {each.key: each for part in parts.values() for each in part.parameters}


def test_an_inline_controller_differs_from_the_library_in_what_it_names_and_not_in_units(cases):
    (case,) = cases("controller: {extends: threshold, slip_threshold: 3 km/h}\n")
    parts = of(case)
    assert (parts["controller"].name, parts["controller"].based_on) == ("threshold", "threshold")
    form = parts_document([parts])[parts["controller"].id]
    (changed_form,) = (each for each in form["parameters"] if each["differs"])
    assert changed_form == {
        "key": "controller.slip_threshold",
        "value": pytest.approx(3 / 3.6, rel=1e-15),
        "unit": "m/s",
        "written": "3 km/h",
        "mark": "user",
        "source": "",
        "differs": True,
        "library_value": 0.9993,
        "library_written": "0.9993 m/s",
    }
    (case,) = cases("controller: {extends: threshold, slip_threshold: 3.59748 km/h}\n")
    assert changed(of(case)) == {}


def test_values_of_the_matrix_and_of_the_command_line_are_among_them(cases):
    text = "matrix: {controller.hold_limit: [1 s, 2 s]}\n"
    first, second = cases(text, "vehicle.body.mass=40 t", "rig.compensation=none")
    common = {"vehicle.body.mass": ("40 t", "32370 kg"), "rig.compensation": ("none", "thermal")}
    assert changed(of(first)) == {**common, "controller.hold_limit": ("1 s", "2 s")}
    assert changed(of(second)) == common


def test_a_friction_or_cleaning_of_the_scenario_stands_in_place_of_the_conditions(cases):
    (wet,) = cases("rail: {condition: wet}\n")
    (slippery,) = cases("rail: {condition: wet, friction: 0.10}\n")
    assert parameters(of(wet))["rail.condition.friction"].value == 0.30
    assert "rail.friction" not in parameters(of(wet))
    assert "rail.condition.friction" not in parameters(of(slippery))
    assert changed(of(slippery)) == {"rail.friction": ("0.10", "0.30")}
    assert of(slippery)["rail"].removed == ()
    own = "{energy: 9 kJ/m, recovered_friction: 0.28, reach: 0.5 m, carry_over: 0.5}"
    (shipped,) = cases("rail: {condition: wet-cleaning}\n")
    (given,) = cases(f"rail: {{condition: wet-cleaning, cleaning: {own}}}\n")
    (alone,) = cases(f"rail: {{condition: wet, cleaning: {own}}}\n")
    assert parameters(of(shipped))["rail.condition.cleaning.energy"].value == 5300.0
    assert "rail.cleaning.energy" not in parameters(of(shipped))
    assert not any(key.startswith("rail.condition.cleaning") for key in parameters(of(given)))
    assert changed(of(given)) == {"rail.cleaning.energy": ("9 kJ/m", "5300 J/m")}
    assert parameters(of(alone))["rail.cleaning.carry_over"].value == 0.5
    own = "{spread: 30 %, correlation_length: 10 m, left_right_correlation: 0.5}"
    (varied,) = cases(f"rail: {{condition: wet-varied, variation: {own}}}\n")
    assert not any(key.startswith("rail.condition.variation") for key in parameters(of(varied)))
    assert changed(of(varied)) == {"rail.variation.spread": ("30 %", "20 %")}


def test_what_sand_does_stands_among_the_numbers_only_of_a_car_with_sanders(cases):
    (without,), (sanded,) = cases(""), cases("sanders: [{wheelset: 2, rate: 1 kg/min}]\n")
    assert not [key for key in parameters(of(without)) if "sand" in key]
    found = parameters(of(sanded))
    assert (found["rail.sand.kept"].written, found["rail.sand.kept"].mark) == ("0.8", "default")
    assert (found["sanders.0.rate"].written, found["sanders.0.rate"].mark) == ("1 kg/min", "user")


def test_the_mark_says_whose_number_it_is(cases):
    (case,) = cases("rail: {gradient: 0 permille}\nvehicle: manchester-benchmark\n")
    found = parameters(of(case))
    marks = {key: found[key].mark for key in ("rail.gradient", "brake.command", "vehicle.body.mass")}
    assert marks == {"rail.gradient": "user", "brake.command": "default", "vehicle.body.mass": "published"}
    assert not found["rail.gradient"].differs
    source = found["vehicle.body.mass"].source
    assert "Iwnicki 1998" in of(case)["vehicle"].sources[source]


def test_criteria_that_were_left_out_or_added_are_told(cases):
    only = "{id: short, layer: requirement, measure: braking_distance, upper: 400 m}"
    (case,) = cases(f"criteria: {{extends: uictest-stop, criteria: [{only}]}}\n")
    profile = of(case)["criteria.0"]
    assert "criteria.locked-wheels" in profile.removed
    assert changed({"criteria.0": profile})["criteria.short.upper"] == ("400 m", "")


def test_every_number_of_every_part_is_there(cases):
    from uictest.plans.scenario.resolution import PART_KEYS

    (case,) = cases("")
    parts = of(case)
    keys = {".".join(map(str, key)) for key in PART_KEYS}
    assert {part.key for part in parts.values() if part.based_on} - {""} == keys - {"criteria"}
    assert parts["criteria.0"].name == "uictest-stop"


def test_the_id_is_that_of_the_content_and_a_shared_part_is_computed_once(cases):
    first, second = (effective_parts(case.scenario) for case in cases("matrix: {seed: [1, 2]}\n"))
    assert all(first[role] is second[role] for role in first if first[role].name)
    assert first["scenario"].id != second["scenario"].id
    (one,), (same,) = cases("title: A\n"), cases("title: B\n")
    (other,) = cases("controller: {extends: threshold, hold_limit: 3 s}\n")
    assert [part.id for part in of(one).values()] == [part.id for part in of(same).values()]
    differing = {role for role in of(one) if of(one)[role].id != of(other)[role].id}
    assert differing == {"controller"}


def test_nothing_of_the_rig_is_said_of_a_recorded_stop(cases):
    (case,) = cases("rail: {condition: wet, friction: 0.10}\nrig: {wsp: bypassed}\n")
    parts = recorded_parts(case.scenario)
    assert list(parts) == ["conditions", "measures", "criteria.0"]
    stated = {each.key: each.written for each in parts["conditions"].parameters}
    assert stated == {
        "rail.condition": "wet",
        "brake.command": "100 %",
        "brake.position": "R",
        "rail.gradient": "0 permille",
        "rig.wsp": "bypassed",
        "record.tolerances.initial_speed": "3 km/h",
        "record.tolerances.deceleration": "1.2",
        "record.tolerances.vacuum": "1.013 bar",
        "record.tolerances.pressure_fall": "0.1 bar",
        "record.tolerances.demanded_pressure": "15 %",
        "record.tolerances.duration": "10",
    }
    simulated = effective_parts(case.scenario).values()
    assert not [each.key for part in simulated for each in part.parameters if "record" in each.key]


def test_own_values_of_single_wheelsets_are_listed_with_their_marks_and_nothing_else_is(cases):
    own = {"wheelsets.2.wheel_radius": "0.4214 m", "wheelsets.4.sensors.speed.method": "whole-teeth"}
    text = "vehicle: intercity-180\n"
    (case,) = cases(text, *(f"vehicle.{key}={value}" for key, value in own.items()))
    (regular,) = cases(text)
    listed = [each for each in of(case)["vehicle"].parameters if "wheelsets" in each.key]
    assert {each.key: each.written for each in listed} == {f"vehicle.{key}": own[key] for key in own}
    assert all(each.differs and each.mark == "user" for each in listed)
    assert not any("wheelsets" in each.key for each in of(regular)["vehicle"].parameters)
