"""`extends` between scenario files."""

from pathlib import Path

import pytest

from uictest.plans.scenario import ScenarioErrors, load

PARENT = """\
schema: uictest/scenario/1
name: parent
initial_speed: 120 km/h
tags: [a, b]
brake: {command: 90 %, position: P}
rail: {condition: wet, friction: 0.2}
matrix: {seed: [1, 2]}
"""


def child(write, more="", extends="parent.yaml"):
    write("set/parent.yaml", PARENT)
    return load(
        [write("set/child.yaml", f"schema: uictest/scenario/1\nname: child\nextends: {extends}\n{more}")]
    )


def test_maps_merge_lists_replace_null_takes_back_and_the_name_is_the_childs(write):
    cases = child(write, "tags: [c]\nbrake: {command: 80 %}\nmatrix: {seed: [7]}\n")
    scenario = cases[0].scenario
    assert [case.id for case in cases] == ["child[seed=7]"]
    assert scenario.tags == ("c",)
    assert (scenario.brake.command, scenario.brake.position) == (0.8, "P")
    assert scenario.rail.friction == 0.2
    assert list(cases[0].inputs)[:2] == ["set/child.yaml", "set/parent.yaml"]
    cases = child(write, "matrix: null\nrail: {friction: null}\n")
    assert [case.id for case in cases] == ["child"]
    assert cases[0].scenario.rail.friction is None


CONDITIONS = [
    "rail: {condition: dry}\n",
    "rail: {condition: {extends: dry}}\n",
    "rail: {condition: {extends: wet, friction: 0.12}}\n",
]


@pytest.mark.parametrize("more", CONDITIONS)
def test_a_new_rail_condition_does_not_keep_the_parents_friction(write, more):
    with pytest.raises(ScenarioErrors) as caught:
        child(write, more)
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.file, diagnostic.line, diagnostic.key) == ("set/child.yaml", 4, "rail.condition")
    assert "rail.friction stays '0.2' (set/parent.yaml:6)" in diagnostic.message
    assert "null takes the friction of the condition" in diagnostic.hint


def test_a_new_rail_condition_with_a_friction_or_none_is_accepted(write):
    same = child(write, "rail: {condition: wet, gradient: 5 permille}\n")[0].scenario.rail
    own = child(write, "rail: {condition: dry, friction: null}\n")[0].scenario.rail
    given = child(write, "rail: {condition: dry, friction: 0.2}\n")[0].scenario.rail
    assert (same.condition.name, same.friction) == ("wet", 0.2)
    assert (own.condition.name, own.highest_friction) == ("dry", 0.55)
    assert (given.condition.name, given.friction) == ("dry", 0.2)


def test_paths_start_at_the_file_that_says_them_and_a_missing_parent_names_the_nearest(write):
    write("cars/heavy.yaml", "schema: uictest/vehicle/1\nextends: intercity-180\nbody: {mass: 40 t}\n")
    write("base/base.yaml", PARENT + "vehicle: ../cars/heavy.yaml\n")
    cases = child(write, extends="../base/base.yaml")
    assert cases[0].scenario.vehicle.body.mass == 40_000.0
    assert "cars/heavy.yaml" in cases[0].inputs
    with pytest.raises(ScenarioErrors) as caught:
        child(write, extends="parnet.yaml")
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.line, diagnostic.column, diagnostic.key) == (3, 10, "extends")
    assert "'parent.yaml'" in diagnostic.hint


@pytest.mark.parametrize("loop", [["a"], ["a", "b"], ["a", "b", "c"]])
def test_a_circle_is_told_at_the_reference_that_closes_it(write, loop):
    for name, after in zip(loop, [*loop[1:], loop[0]], strict=True):
        write(f"{name}.yaml", f"schema: uictest/scenario/1\nname: {name}\nextends: {after}.yaml\n")
    with pytest.raises(ScenarioErrors) as caught:
        load([Path("a.yaml")])
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.file, diagnostic.line, diagnostic.column) == (f"{loop[-1]}.yaml", 3, 10)
    assert "circular 'extends': a.yaml -> " in diagnostic.message


def test_an_error_in_a_parent_points_into_it_and_a_parent_is_a_scenario_of_so_many_generations(write):
    write("base.yaml", PARENT.replace("120 km/h", "fast"))
    with pytest.raises(ScenarioErrors) as caught:
        child(write, extends="../base.yaml")
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.file, diagnostic.line, diagnostic.column) == ("base.yaml", 3, 16)
    write("car.yaml", "schema: uictest/vehicle/1\nname: car\n")
    with pytest.raises(ScenarioErrors, match="expected uictest/scenario/1, found 'uictest/vehicle/1'"):
        child(write, extends="../car.yaml")
    for number in range(20):
        write(f"{number}.yaml", f"schema: uictest/scenario/1\nname: g\nextends: {number + 1}.yaml\n")
    with pytest.raises(ScenarioErrors, match="more than 16 generations"):
        load([Path("0.yaml")])
