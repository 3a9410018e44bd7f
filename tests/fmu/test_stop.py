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
    names = ("slide", "adhesion", "wheel_load", "tank_pressure", "clamping_force", "brake_torque")
    for name, channel in {"true_wheel_speed": "wheel_speed", **dict(zip(names, names, strict=True))}.items():
        for number in (1, 2, 3, 4):
            assert stepped.end[f"{name}_{number}"] == ran.recording[f"{channel}_{number}"][-1], (name, number)


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
def test_two_instances_do_not_disturb_each_other_and_begin_at_any_time(instance, version):
    alone, first, second = instance(version), instance(version, start_time=100.0), instance(version)
    for cycle in range(200):
        alone.step()
        first.step()
        second.step(hold=[1] * 4, vent=[cycle % 2] * 4)
    assert first["train_speed"] == alone["train_speed"]
    assert first["time"] == pytest.approx(102.0)
    assert second["train_speed"] > alone["train_speed"]


@VERSIONS
def test_reset_gives_the_same_stop_and_forgets_the_seed(instance, version):
    """The seed may be set before or in the initialization."""
    early, late, neither = instance(version, seed=6), instance(version, late=True, seed=6), instance(version)
    assert early.four("wheel_speed") == late.four("wheel_speed") != neither.four("wheel_speed")
    marks = []
    for seed in ({}, {"seed": 6}, {"seed": 5}, {}):
        if marks:
            neither.fmu.reset()
            neither.begin(**seed)
        for _ in range(150):
            neither.step()
        marks.append(neither.four("wheel_speed"))
    assert marks[0] == marks[2] == marks[3] != marks[1]


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
def test_a_step_at_another_time_a_late_parameter_and_an_output_that_is_set_are_errors(instance, version):
    each = instance(version)
    each.steps = 5
    with pytest.raises(Exception, match="DoStep"):
        each.step()
    each.fmu.reset()
    each.begin()
    whole, real = (
        (each.fmu.setInteger, each.fmu.setReal) if version == 2 else (each.fmu.setInt64, each.fmu.setFloat64)
    )
    for setter, name, value in ((whole, "seed", 1), (real, "train_speed", 1.0)):
        with pytest.raises(Exception, match="Set"):
            setter([each.variables[name].valueReference], [value])
    step, parameter, output = each.messages
    assert step == "the communication point is 0.05 s; the last step ended at 0 s"
    assert parameter == "a parameter can only be set before the end of the initialization"
    assert "cannot be set" in output


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
def test_a_share_that_no_reduction_has_is_an_error_with_its_name(made, instance, share):
    made.set_all(dynamic_reduction_3=share)
    with pytest.raises(Exception, match="DoStep"):
        made.step()
    [text] = made.messages
    assert text.startswith("dynamic_reduction_3 is ")
    assert text.endswith("expected 0 to 1")
    added = {"dynamic_reduction_1", "track_brake_request", "axle_load"}
    assert not added & instance(2).variables.keys(), "version 1 has no such variables"
