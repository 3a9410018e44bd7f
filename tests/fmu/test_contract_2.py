"""An FMU of the rig whose commands keep version 2 of the contract: other brakes than the valves."""

import pytest

import uictest
from uictest.api import fmu
from uictest.plans.scenario import load

from .conftest import Instance

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
