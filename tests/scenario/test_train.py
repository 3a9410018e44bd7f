"""Scenarios of trains: a case for each car, and what cannot be coupled."""

import re

import pytest

from uictest.plans.scenario import ScenarioErrors, load

from .conftest import refusals

TRAIN = """
schema: uictest/scenario/1
name: short
initial_speed: 40 km/h
rail: {condition: wet, friction: 0.07}
"""


@pytest.fixture
def cases(write):
    """Write a scenario and return its cases."""
    return lambda more, *overrides, beside=TRAIN: load([write("train.yaml", beside + more)], overrides)


def test_every_car_is_a_case_with_what_it_has_of_its_own(cases):
    loaded = cases(
        "train:\n"
        "  - {vehicle: crh380a, brake: {system: distributor}, expect: fail}\n"
        "  - {count: 2, controller: slip-band}\n"
        "brake: {command: 80 %, transmission: {pipe: 250 m/s}}\n"
    )
    assert [case.id for case in loaded] == ["short[car=1]", "short[car=2]", "short[car=3]"]
    scenarios = [case.scenario for case in loaded]
    assert [each.vehicle.name for each in scenarios] == ["crh380a", "intercity-180", "intercity-180"]
    assert [each.brake.system.name for each in scenarios] == ["distributor", "ep-disc", "ep-disc"]
    assert [each.controller.name for each in scenarios] == ["threshold", "slip-band", "slip-band"]
    assert [str(each.expect) for each in scenarios] == ["fail", "pass", "pass"]
    assert {each.brake.command.text for each in scenarios} == {"80 %"}
    assert {each.brake.transmission.pipe for each in scenarios} == {250.0}
    assert {each.coupler.stiffness for each in scenarios} == {5e6}
    assert all(case.train.scenarios == tuple(scenarios) for case in loaded)
    assert [case.parameters["car"] for case in loaded] == ["1", "2", "3"]


def test_a_scenario_without_train_is_a_car_alone_and_a_train_takes_the_place_of_a_vehicle(cases, write):
    (alone,) = cases("vehicle: crh380a\n")
    assert (alone.id, alone.train, alone.cars, alone.scenario.coupler) == ("short", None, (alone,), None)
    write("parent.yaml", TRAIN.replace("short", "parent") + "vehicle: crh380a\n")
    child = "schema: uictest/scenario/1\nname: child\nextends: parent.yaml\n"
    first, _ = cases("train: [{count: 2}]\n", beside=child)
    assert first.scenario.vehicle.name == "intercity-180"
    (alone,) = cases("train: null\n", beside=child)
    assert alone.scenario.vehicle.name == "crh380a"


def test_lists_and_values_of_the_command_line_reach_single_cars(cases):
    train = "train: [{count: 2}, {vehicle: crh380a}]\nmatrix: {rail.friction: [0.07, 0.08]}\n"
    loaded = cases(train, "train.0.vehicle.half_pivot_distance=9 m", "train.1.count=1")
    assert [case.id for case in loaded] == [
        f"short[friction={friction},car={car}]" for friction in ("0.07", "0.08") for car in (1, 2, 3)
    ]
    assert [float(case.scenario.vehicle.half_pivot_distance) == 9.0 for case in loaded[:3]] == [
        True,
        True,
        False,
    ]


NO_TRAINS = refusals("""\
vehicle: crh380a
train: [{count: 2}]
-> train.yaml:6:1: vehicle: the cars of a train have vehicles of their own
train: []
-> 6:8: train: expected a list of cars, found an empty list
train: crh380a
-> 6:8: train: expected a list of cars, found a text
train: [crh380a]
-> 6:9: train.0: expected a mapping, found a text
train: [{count: 0}]
-> 6:17: train.0.count: expected a whole number from 1 to 32
train: [{count: true}]
-> train.0.count: expected a whole number
train: [{count: 2.5}]
-> train.0.count: expected a whole number
train: [{count: 20}, {count: 13}]
-> 6:8: train: 33 cars; a train has at most 32
train: [{vehicel: crh380a}]
-> 6:10: train.0.vehicel: unknown key 'vehicel' | did you mean 'vehicle'?
train:
  - {seed: 3, rail: {friction: 0.1}}
  - {simulation: {time_step: 1 ms}}
-> 7:6: train.0.seed: a train has one seed
-> write seed beside `train`; a car has vehicle, count, brake, rig, controller, sanders,
-> 7:15: train.0.rail: a train has one rail
-> 8:6: train.1.simulation: a train has one simulation
train: [{brake: {transmission: wire}}]
-> 6:18: train.0.brake.transmission: a train has one transmission
train: [{vehicle: crh38a}, {brake: {command: 120 %}}]
-> 6:19: train.0.vehicle: no vehicle 'crh38a' in the library
-> 6:46: train.1.brake.command: 120 % is out of range
train: [{}, {faults: [{part: speed-sensor}]}]
matrix: {train.1.brake.command: [70 %, 7 m]}
-> 6:23: train.1.faults.0.at: missing key 'at' | 7:40: train.1.brake.command: unknown unit 'm'
train: [{}, {}]
brake: {command: 120 %}
-> 7:18: brake.command: 120 % is out of range
coupler: {damping: 1 MN s/m}
-> 6:1: coupler: only a train has it
brake: {transmission: wire}
-> 6:9: brake.transmission: only a train has it
train: [{}, {}]
coupler: {stiffness: 0 N/m}
-> 7:22: coupler.stiffness: 0 N/m is out of range: it must be at least 100 kN/m
train: [{}]
coupler: {slack: 2 mm}
-> 7:11: coupler.slack: unknown key 'slack'
train: [{count: 2}]
brake: {transmission: {pipe: 250}}
-> 7:30: brake.transmission.pipe: '250' has no unit
train: [{}, {controller: {extends: slip-band, cycle_time: 5 ms}}]
-> 6:26: train.1.controller: a controller cycle of 5 ms; that of the first car is 10 ms
train: [{count: 3}]
coupler: {distance: 20 m}
-> 7:21: coupler.distance: 20 m let the wheels of neighbouring cars overlap | more than 21.36 m
train: [{vehicle: crh380a}, {}]
coupler: {damping: 10 MN s/m}
simulation: {time_step: 1 ms}
-> 7:10: coupler: too stiff or too much damped for a body of 32.37 t with a step of 1 ms
""")


@pytest.mark.parametrize(("more", "expected"), [(more, expected) for more, *expected in NO_TRAINS])
def test_what_is_no_train_is_said_at_its_place(cases, more, expected):
    with pytest.raises(ScenarioErrors) as errors:
        cases(more)
    text = re.sub(r"\s+", " ", str(errors.value))
    assert [each for each in expected if each not in text] == []


def test_every_car_names_what_all_of_its_train_was_read_from_and_changes_with_it(write, cases):
    vehicle = "schema: uictest/vehicle/1\nname: {name}\nextends: crh380a\n"
    for name in ("lead", "last"):
        write(f"{name}.yaml", vehicle.format(name=name))
    files = [list(case.inputs) for case in cases("train: [{vehicle: lead.yaml}, {vehicle: last.yaml}]\n")]
    assert files[0] == files[1]
    assert {name.rpartition("/")[2] for name in files[0]} >= {"train.yaml", "lead.yaml", "last.yaml"}
    second = cases("train: [{count: 3}]\n")[1].with_values(seed=7)
    assert {case.scenario.seed for case in second.cars} == {7}
    assert second.train.number == 2


OUTSIDE = "{controller: {python: %s, class: W}}"


def test_programs_of_a_train_lie_in_one_folder(write, cases):
    """A process holds one module of a name: what lies beside one file would serve the other."""
    for name in ("wsp.py", "twin.py", "other/wsp.py"):
        write(name, "class W:\n    def step(self, inputs, outputs): ...\n")
    cars = [OUTSIDE % name for name in ("wsp.py", "twin.py", "wsp.py")]
    loaded = cases(f"train: [{{}}, {', '.join(cars)}]\n")
    assert [case.scenario.controller.program is None for case in loaded] == [True, False, False, False]
    told = r"train\.2\.controller: its controller is loaded from .*/other, that of car 2 from"
    with pytest.raises(ScenarioErrors, match=told):
        cases(f"train: [{{}}, {OUTSIDE % 'wsp.py'}, {OUTSIDE % 'other/wsp.py'}]\n")


def test_a_program_at_a_socket_serves_one_car_and_asks_for_no_folder_beside_it(cases, write):
    at = "controller: {connect: 'tcp://127.0.0.1:%d'}"
    apart, twice = f"train: [{{{at % 1}}}, {{{at % 2}}}]\n", f"train: [{{{at % 1}, count: 2}}]\n"
    assert len(cases(apart)) == 2
    with pytest.raises(ScenarioErrors, match=r"127\.0\.0\.1:1 is the address of car 1, too"):
        cases(twice)
    write("wsp.py", "class W: ...\n")
    both = [OUTSIDE % "wsp.py", "{controller: {connect: 'tcp://127.0.0.1:1'}}"]
    for cars in (both, both[::-1]):
        with pytest.raises(ScenarioErrors, match="where a car has a program at a socket"):
            cases(f"train: [{', '.join(cars)}]\n")


OWN = "train: [{controller: slip-band}, {controller: {extends: threshold, cycle_time: 10 ms}}]\n"


@pytest.mark.parametrize(
    ("more", "overrides"),
    [("", ["controller=threshold"]), ("matrix: {controller: [threshold, slip-band]}\n", [])],
)
def test_a_value_that_no_car_of_the_train_has_is_an_error(cases, more, overrides):
    """Cases of two such values would be one stop under two names."""
    told = "controller: every car of the train has a 'controller' of its own"
    with pytest.raises(ScenarioErrors, match=told):
        cases(OWN + more, *overrides)
    one = OWN.replace("{controller: slip-band}", "{expect: fail}")
    assert {case.scenario.controller.name for case in cases(one + more, *overrides)} >= {"threshold"}
