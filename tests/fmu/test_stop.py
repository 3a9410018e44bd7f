"""A stop that is stepped through FMPy is the stop of `run`, to the bit."""

import pytest

import uictest
from uictest import rig
from uictest.api import fmu
from uictest.plans.scenario import load

from .conftest import Instance

VERSIONS = pytest.mark.parametrize("version", [2, 3])
PascalPerBar = 1e5


@VERSIONS
def test_a_stop_has_the_bits_of_run(instance, controller_outside, case, version):
    ran = rig.simulate(case, record_every=0.01)
    assert ran.recording is not None
    stepped = instance(version).run(controller_outside(case))
    assert stepped.history == ran.recording["speed"][1:].tolist()
    assert stepped.end["braking_distance"] == ran.measures.braking_distance
    assert stepped.end["braking_time"] == ran.measures.braking_time
    assert stepped.end["stopped"]
    for fmu_name, channel in (
        ("true_wheel_speed", "wheel_speed"),
        ("slide", "slide"),
        ("adhesion", "adhesion"),
        ("wheel_load", "wheel_load"),
        ("tank_pressure", "tank_pressure"),
        ("clamping_force", "clamping_force"),
        ("brake_torque", "brake_torque"),
    ):
        for number in (1, 2, 3, 4):
            recorded = ran.recording[f"{channel}_{number}"][-1]
            assert stepped.end[f"{fmu_name}_{number}"] == recorded, (fmu_name, number)


@VERSIONS
def test_the_sensors_show_the_brake_command(instance, version):
    rig_instance = instance(version)
    assert rig_instance["train_speed"] == pytest.approx(40 / 3.6)
    assert rig_instance.four("wheel_speed") == pytest.approx([40 / 3.6] * 4, rel=0.02)
    assert rig_instance.four("speed_valid") == [True] * 4
    assert rig_instance["brake_demand"] == 0.0
    for _ in range(300):
        rig_instance.step()
    assert rig_instance["brake_demand"] == pytest.approx(1.0)
    assert min(rig_instance.four("cylinder_pressure")) > 2 * PascalPerBar


@VERSIONS
def test_two_instances_do_not_disturb_each_other(instance, version):
    alone, first, second = (instance(version) for _ in range(3))
    for _ in range(200):
        alone.step()
    for cycle in range(200):
        first.step()
        second.step(hold=[1] * 4, vent=[cycle % 2] * 4)
    assert first["train_speed"] == alone["train_speed"]
    assert second["train_speed"] > alone["train_speed"]


@VERSIONS
def test_reset_gives_the_same_stop_and_forgets_the_seed(instance, version):
    each = instance(version)
    marks = []
    for seed in ({}, {"seed": 6}, {"seed": 5}, {}):
        if marks:
            each.fmu.reset()
            each.begin(**seed)
        for _ in range(150):
            each.step()
        marks.append(each.four("wheel_speed"))
    assert marks[0] == marks[2] == marks[3] != marks[1]


@VERSIONS
def test_the_seed_may_be_set_before_or_in_the_initialization(instance, version):
    early, late, neither = instance(version, seed=6), instance(version, late=True, seed=6), instance(version)
    assert early.four("wheel_speed") == late.four("wheel_speed") != neither.four("wheel_speed")


@VERSIONS
def test_going_back_to_an_earlier_state(instance, version):
    each = instance(version)
    for _ in range(100):
        each.step()
    get, put, free = (
        (each.fmu.getFMUstate, each.fmu.setFMUstate, each.fmu.freeFMUstate)
        if version == 2
        else (each.fmu.getFMUState, each.fmu.setFMUState, each.fmu.freeFMUState)
    )
    kept, marks = get(), []
    for _ in range(2):
        for _ in range(100):
            each.step()
        marks.append((each["train_speed"], each["time"]))
        put(kept)
        each.steps = 100
    free(kept)
    assert marks[0] == marks[1]


@VERSIONS
def test_after_the_end_time_goes_on_and_the_outputs_stay(instance, version):
    each = instance(version)
    while not each["ended"]:
        each.step()
    distance, time = each["distance"], each["time"]
    each.step()
    assert (each["distance"], each["stopped"]) == (distance, True)
    assert each["time"] == pytest.approx(time + 0.01)


@VERSIONS
def test_a_simulation_may_begin_at_any_time(instance, version):
    late, early = instance(version, start_time=100.0), instance(version)
    for _ in range(50):
        late.step()
        early.step()
    assert late["time"] == pytest.approx(100.5)
    assert late["train_speed"] == early["train_speed"]


@VERSIONS
@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"size": 0.02}, "the communication step is 0.02 s; it must be the controller cycle, 0.01 s"),
        ({"size": 0.0}, "the communication step is 0 s; it must be the controller cycle, 0.01 s"),
        ({"vent": [0, 0, 1, 0]}, "vent_3 without hold_3 is forbidden: both are true in order to vent"),
    ],
)
def test_a_step_that_the_rig_cannot_take_is_an_error(instance, version, wrong, message):
    each = instance(version)
    with pytest.raises(Exception, match="DoStep"):
        each.step(**wrong)
    assert each.messages == [message]
    each.step()
    assert each["time"] == pytest.approx(0.01)


@VERSIONS
def test_a_step_at_another_time_is_an_error(instance, version):
    each = instance(version)
    each.steps = 5
    with pytest.raises(Exception, match="DoStep"):
        each.step()
    assert each.messages == ["the communication point is 0.05 s; the last step ended at 0 s"]


@VERSIONS
def test_a_parameter_is_fixed_once_the_stop_has_begun(instance, version):
    each = instance(version)
    setter = each.fmu.setInteger if version == 2 else each.fmu.setInt64
    with pytest.raises(Exception, match="Set"):
        setter([each.variables["seed"].valueReference], [1])
    assert each.messages == ["a parameter can only be set before the end of the initialization"]


@VERSIONS
def test_an_output_cannot_be_set(instance, version):
    each = instance(version)
    setter = each.fmu.setReal if version == 2 else each.fmu.setFloat64
    with pytest.raises(Exception, match="Set"):
        setter([each.variables["train_speed"].valueReference], [1.0])
    assert "cannot be set" in each.messages[0]


MOTORS = """schema: uictest/scenario/1
name: motors
initial_speed: 40 km/h
brake:
  dynamic: {force: 60 kN, power: 1.6 MW}
  track: {attraction: 50 kN, when: requested, delay: 0 s}
sanders: [{wheelset: 1, when: requested, rate: 2 kg/min}]
rig: {sensors: {extends: standard, train_speed: {}, acceleration: {}}}
controller: {connect: "tcp://127.0.0.1:1"}
"""


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory):
    path = tmp_path_factory.mktemp("motors") / "motors.yaml"
    path.write_text(MOTORS, "utf-8")
    return path


@pytest.fixture(name="file", scope="module", params=[2, 3])
def _file(path, request):
    target = path.with_name(f"rig{request.param}.fmu")
    target.write_bytes(fmu.build_fmu(load([path])[0], request.param, contract=2))
    return target


@pytest.fixture(name="made")
def _made(file):
    instance = Instance(file)
    yield instance
    instance.close()


def test_a_stop_has_the_bits_of_the_rig_in_python_under_the_same_commands(made, path):
    """A reduced motor, sand and the track brake: each command of version 2 arrives."""
    stepped = uictest.Rig(path, contract=2)
    inputs = stepped.reset()
    made.set_all(dynamic_reduction_2=1.0, dynamic_reduction_3=0.25, sand_request_1=True)
    while not stepped.stopped:
        assert made["axle_load"] == inputs.axle_load
        assert made["brake_command"] == inputs.brake_command
        assert made["measured_train_speed"] == inputs.train_speed
        assert made["acceleration"] == inputs.acceleration
        assert made["train_speed_valid"] == made["acceleration_valid"] == 1
        assert made.four("dynamic_brake") == list(inputs.dynamic_brake)
        braked = inputs.cycle >= 100
        made.set_all(track_brake_request=braked)
        made.step(hold=[0, 0, 0, 1])
        inputs = stepped.step(
            hold=[0, 0, 0, 1],
            dynamic_reduction=[0.0, 1.0, 0.25, 0.0],
            sand_request=[1, 0, 0, 0],
            track_brake_request=braked,
        )
    assert made["braking_distance"] == stepped.result().measures["braking_distance_m"] > 0.0
    assert stepped.result().measures["track_brake_time_s"] > 0.0


@pytest.mark.parametrize("share", [-0.1, 1.5, float("nan")])
def test_a_share_that_no_reduction_has_is_an_error_with_its_name(made, share):
    made.set_all(dynamic_reduction_3=share)
    with pytest.raises(Exception, match="DoStep"):
        made.step()
    [text] = made.messages
    assert text.startswith("dynamic_reduction_3 is ")
    assert text.endswith("expected 0 to 1")


def test_version_1_has_no_such_variables(instance):
    assert not {"dynamic_reduction_1", "track_brake_request", "axle_load"} & instance(2).variables.keys()
