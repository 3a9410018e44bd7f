"""`uictest.TrainRig`: a train that a program steps, and what it is told when it calls wrongly."""

from dataclasses import replace

import numpy as np
import pytest

import uictest
from uictest.controllers import Outputs
from uictest.judging.evaluation import result_document
from uictest.plans.scenario import load
from uictest.running import campaign

FILL = Outputs((0, 0, 0, 0), (0, 0, 0, 0))
TRAIN = (
    "schema: uictest/scenario/1\nname: train\ninitial_speed: 30 km/h\n"
    "train: [{vehicle: intercity-180}, {vehicle: intercity-180, count: 2, brake: {command: 60 %}}]\n"
    "brake: {transmission: {pipe: 250 m/s}}\nrail: {condition: wet-cleaning, friction: 0.06}\n"
)


@pytest.fixture(name="write_train")
def _write_train(tmp_path):
    def write(extra=""):
        path = tmp_path / "train.yaml"
        path.write_text(TRAIN + extra)
        return path

    return write


def drive(rig, controllers):
    """Step a train to its end with a controller outside for each car."""
    inputs = rig.reset()
    while not rig.stopped:
        magnets = [
            controller.magnets(own.wheel_speed) for controller, own in zip(controllers, inputs, strict=True)
        ]
        speeds = [controller.reference_speed for controller in controllers]
        inputs = rig.step([Outputs(*each, speed) for each, speed in zip(magnets, speeds, strict=True)])
    return rig.result()


def test_a_train_has_results_and_recordings_of_run(write_train, controller_outside):
    path = write_train()
    rig = uictest.TrainRig(path, record=100)
    cases = load([path])
    request = campaign.RecordingRequest("all", every=0.01)
    runs = [run.case_run for run in campaign.run_train([campaign.Stop(case) for case in cases], request)]
    results = drive(rig, [controller_outside(case) for case in cases[0].cars])
    expected = [replace(run.result, controller_contract=1) for run in runs]  # one from outside keeps one
    assert result_document(results) == result_document(expected)
    assert results[1].train.ahead.largest_pull_n > 0.0
    for recorded, run in zip(rig.recording(), runs, strict=True):
        assert recorded.units == run.recording.units | {"diagnosis": "1"}
        assert recorded.metadata | {"controller": "threshold"} == run.recording.metadata  # ours has no name
        for name in run.recording.channels:
            np.testing.assert_array_equal(recorded[name], run.recording[name])


def test_a_car_alone_is_a_train_of_one(write_scenario, controller_outside):
    path = write_scenario("seed: 3\n")
    rig, alone = uictest.TrainRig(path, record=50), uictest.Rig(path, record=50)
    controller = controller_outside(alone.case)
    inputs = alone.reset(5)
    assert rig.reset(5) == (inputs,)
    while not alone.stopped:
        outputs = Outputs(*controller.magnets(inputs.wheel_speed))
        inputs = alone.step(outputs)
        assert rig.step([outputs]) == (inputs,)
        assert rig.state == (alone.state,)
    assert rig.stopped and rig.stands and rig.coupler_forces == ()
    assert result_document(rig.result()) == result_document([alone.result()])
    [recording] = rig.recording()
    assert recording.metadata == alone.recording().metadata
    for name, samples in alone.recording().channels.items():
        np.testing.assert_array_equal(recording[name], samples)


def test_couplers_carry_what_the_cars_brake_unequally(write_train):
    """The leading car brakes most: the others push it, the more the farther ahead the coupler is."""
    rig = uictest.TrainRig(write_train())
    rig.reset()
    assert rig.coupler_forces == (0.0, 0.0)
    while rig.state[0].time < 4.0:
        rig.step([FILL] * 3)
    first, second = rig.coupler_forces
    assert first < second < 0.0
    assert rig.cycle_time == 0.01


def test_the_seed_decides_the_noise_which_differs_from_car_to_car(write_train):
    rig = uictest.TrainRig(write_train("seed: 7\n"))
    first, again, other = rig.reset(), rig.reset(7), rig.reset(8)
    assert first == again
    assert first[0].wheel_speed != other[0].wheel_speed
    assert first[1].wheel_speed != first[2].wheel_speed


@pytest.mark.parametrize(
    ("outputs", "message"),
    [
        (FILL, "^outputs is Outputs, expected a list, one for each car$"),
        (None, "^outputs is NoneType, expected a list"),
        ([FILL, FILL], "^2 outputs, expected one for each of 3 cars$"),
        ([FILL, Outputs((0, 0, 0), (0,) * 4), FILL], "^car 2: hold has 3 values, expected 4"),
        ([FILL, FILL, Outputs((0,) * 4, (0, 1, 0, 0))], r"^car 3: vent\[1\] is 1 and hold\[1\] is 0"),
        ([FILL, 1, FILL], "^car 2: step returned int, expected Outputs"),
        ([Outputs((0,) * 4, (0,) * 4, sand_request=(0,) * 4), FILL, FILL], "^car 1: sand_request belongs to"),
    ],
)
def test_commands_that_no_valve_has_name_the_car_and_move_none(write_train, outputs, message):
    rig = uictest.TrainRig(write_train())
    rig.reset()
    before = rig.state
    with pytest.raises(ValueError, match=message):
        rig.step(outputs)
    assert rig.state == before
    assert [inputs.cycle for inputs in rig.step([FILL] * 3)] == [1, 1, 1]


def test_version_2_of_the_contract_holds_for_all_cars(write_train):
    rig = uictest.TrainRig(write_train(), record=20, contract=2)
    rig.reset()
    with pytest.raises(ValueError, match=r"^car 2: dynamic_reduction\[1\] is 2.0, expected 0 to 1$"):
        rig.step([FILL, Outputs((0,) * 4, (0,) * 4, dynamic_reduction=(0, 2, 0, 0)), FILL])
    while not rig.stopped:
        rig.step([FILL, FILL, FILL])
    assert set(rig.recording()[2]["sand_request_1"]) == {0.0}


def test_one_of_several_trains_is_chosen_by_its_id_and_no_car_of_it(write_train):
    path = write_train("matrix: {seed: [0, 1]}\n")
    rig = uictest.TrainRig(path, "train[seed=1]")
    assert [case.id for case in rig.cases] == [f"train[seed=1,car={car}]" for car in (1, 2, 3)]
    with pytest.raises(ValueError, match=r"2 trains: pass case= one of train\[seed=0\], train\[seed=1\]"):
        uictest.TrainRig(path)
    with pytest.raises(ValueError, match=r"no train 'train\[seed=0,car=1\]'; did you mean"):
        uictest.TrainRig(path, "train[seed=0,car=1]")
    with pytest.raises(ValueError, match=r"car 2 of 3: step its train with uictest.TrainRig$"):
        uictest.Rig(write_train(), "train[car=2]")
    with pytest.raises(ValueError, match=r"car 1 of 3: step its train with uictest.TrainRig$"):
        uictest.Rig(write_train())


def test_calls_before_a_stop_are_refused(write_train):
    rig = uictest.TrainRig(write_train())
    for call in (lambda: rig.step([FILL] * 3), lambda: rig.state, lambda: rig.coupler_forces, rig.result):
        with pytest.raises(RuntimeError, match=r"call reset\(\)"):
            call()
