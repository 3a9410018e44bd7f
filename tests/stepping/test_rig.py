"""`uictest.Rig`: what a program of its own gets, and what it is told when it calls wrongly."""

import math
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

import uictest
from uictest.controllers import Outputs
from uictest.judging.evaluation import result_document
from uictest.plans.scenario import ScenarioErrors, load
from uictest.running import campaign

TWO_CASES = "matrix:\n  brake.command: [80 %, 90 %]\n"


def drive(rig, controller):
    """Step a stop to its end with a controller outside."""
    inputs = rig.reset()
    while not rig.stopped:
        hold, vent = controller.magnets(inputs.wheel_speed)
        inputs = rig.step(Outputs(hold, vent, controller.reference_speed))
    return rig.result()


def test_a_stop_has_result_and_recording_of_run(write_scenario, controller_outside):
    path = write_scenario()
    rig = uictest.Rig(path, record=100)
    [case] = load([path])
    run = campaign.run_stop(campaign.Stop(case), campaign.RecordingRequest("all", every=0.01)).case_run
    expected = replace(run.result, controller_contract=1)  # one from outside keeps one
    assert result_document([drive(rig, controller_outside(case))]) == result_document([expected])
    recorded, of_run = rig.recording(), run.recording
    assert recorded.units == of_run.units | {"diagnosis": "1"}
    assert recorded.metadata | {"controller": "threshold"} == of_run.metadata  # ours has no name
    for name in of_run.channels:
        np.testing.assert_array_equal(recorded[name], of_run[name])


def test_the_controller_that_the_scenario_names_plays_no_part_but_its_cycle_time_holds(write_scenario):
    marks = []
    for name in ("threshold", "slip-band"):
        rig = uictest.Rig(write_scenario(f"controller: {{extends: {name}, cycle_time: 20 ms}}\n"))
        rig.reset()
        for _ in range(100):
            inputs = rig.step()
        assert inputs.time == pytest.approx(2.0)
        assert rig.cycle_time == 0.02
        marks.append(rig.state)
    assert marks[0] == marks[1]


def test_seed_decides_the_noise_and_inputs_are_plain_numbers(write_scenario):
    rig = uictest.Rig(write_scenario("seed: 7\n"))
    first = rig.reset()
    assert rig.reset(7) == first
    for seed in (8, 0, 2**32 - 1):
        assert rig.reset(seed).wheel_speed != first.wheel_speed
    inputs = uictest.Rig(write_scenario()).reset()
    assert {type(value) for value in (*inputs.wheel_speed, *inputs.cylinder_pressure)} == {float}


def test_the_state_is_the_true_one(write_scenario):
    rig = uictest.Rig(write_scenario())
    rig.reset()
    assert (rig.state.time, rig.state.distance) == (0.0, 0.0)
    assert rig.state.train_speed == pytest.approx(30 / 3.6)
    for _ in range(300):
        inputs = rig.step()
    assert max(rig.state.slide) > 0.2
    assert rig.state.wheel_speed == pytest.approx(inputs.wheel_speed, abs=0.1)
    assert rig.state.distance < 30 / 3.6 * rig.state.time


def test_the_state_is_what_a_recording_shows_of_each_wheelset(write_scenario):
    rig = uictest.Rig(write_scenario(), record=100)
    rig.reset()
    states = [rig.state]
    while not rig.stopped:
        # Another command for each wheelset, so that none is like another.
        rig.step(hold=[0, 1, 1, len(states) % 2], vent=[0, 0, len(states) % 2, 0])
        states.append(rig.state)
    recording, states = rig.recording(), states[:200]
    at = np.searchsorted(recording["time"], [state.time - 1e-6 for state in states])
    of_train = {"distance": "distance", "train_speed": "speed", "reservoir_pressure": "reservoir_pressure"}
    for name, channel in of_train.items():
        shown = [getattr(state, name) for state in states]
        np.testing.assert_array_equal(shown, recording[channel][at])
    for name in ("wheel_speed", "slide", "friction", "tank_pressure", "clamping_force", "brake_torque"):
        recorded = np.transpose([recording[f"{name}_{number}"][at] for number in (1, 2, 3, 4)])
        np.testing.assert_array_equal([getattr(state, name) for state in states], recorded, name)


@pytest.mark.parametrize("record", [0, -1, math.inf, math.nan, "100"])
def test_a_rate_that_is_no_number_of_samples_per_second_is_refused(write_scenario, record):
    with pytest.raises(ValueError, match="expected samples per second or None"):
        uictest.Rig(write_scenario(), record=record)


def test_no_sample_is_recorded_more_often_than_each_step(write_scenario):
    rig = uictest.Rig(write_scenario("simulation: {maximum_duration: 20 s}\n"), record=1e9)
    rig.reset()
    while not rig.stopped:
        rig.step()
    step = float(rig.case.scenario.simulation.time_step)
    np.testing.assert_allclose(np.diff(rig.recording()["time"]), step, rtol=1e-6)


def test_one_of_several_cases_is_chosen_by_its_id_and_an_invalid_file_is_reported_as_by_check(write_scenario):
    path = write_scenario(TWO_CASES)
    assert uictest.Rig(path, "stop[command=90]").case.parameters == {"brake.command": "90 %"}
    with pytest.raises(
        ValueError, match=r"2 cases: pass case= one of stop\[command=80\], stop\[command=90\]"
    ):
        uictest.Rig(path)
    with pytest.raises(ValueError, match=r"no case 'stop\[command=91\]'; did you mean"):
        uictest.Rig(path, "stop[command=91]")
    with pytest.raises(ScenarioErrors, match=r"stop.yaml:5:\d+: brake.command"):
        uictest.Rig(write_scenario("brake: {command: 200 %}\n"))


def test_calls_out_of_order_are_refused(write_scenario):
    rig = uictest.Rig(write_scenario("simulation: {maximum_duration: 60 s}\n"))
    for call in (rig.step, lambda: rig.stopped, lambda: rig.state, rig.result):
        with pytest.raises(RuntimeError, match=r"call reset\(\)"):
            call()
    rig.reset()
    with pytest.raises(RuntimeError, match=r"not ended after 0 s: call step\(\)"):
        rig.result()
    with pytest.raises(RuntimeError, match="record=100"):
        rig.recording()
    while not rig.stopped:
        rig.step()
    assert rig.stands
    with pytest.raises(RuntimeError, match=r"ended after .* s: call reset\(\)"):
        rig.step()
    rig.reset()
    assert not rig.stopped


@pytest.mark.parametrize(
    ("commands", "message"),
    [
        ({"hold": [0, 0, 0], "vent": [0] * 4}, "hold has 3 values, expected 4"),
        ({"hold": [0] * 4, "vent": [0, math.nan, 0, 0]}, r"vent\[1\] is nan, expected 0 or 1"),
        ({"hold": [0, 0, 2, 0]}, r"hold\[2\] is 2, expected 0 or 1"),
        ({"hold": 1}, "hold is 1, expected 4 values"),
        ({"vent": [0, 0, 0, 1]}, r"vent\[3\] is 1 and hold\[3\] is 0, which is forbidden"),
        ({"reference_speed": -math.inf}, "reference_speed is -inf, expected a number or NaN"),
        ({"diagnosis": 2**32}, "diagnosis is 4294967296, expected a whole number of 32 bits"),
    ],
)
def test_commands_that_no_valve_has_leave_the_stop_where_it_is(write_scenario, commands, message):
    rig = uictest.Rig(write_scenario())
    rig.reset()
    before = rig.state
    with pytest.raises(ValueError, match=message):
        rig.step(**commands)
    assert rig.state == before
    assert rig.step().cycle == 1


@pytest.mark.parametrize("seed", [-1, 2**32, 1.5, "1", True])
def test_a_seed_out_of_range_is_refused(write_scenario, seed):
    with pytest.raises(ValueError, match="expected a whole number from 0 to 4294967295"):
        uictest.Rig(write_scenario()).reset(seed)


def test_the_package_is_imported_without_the_rig():
    program = "import sys, uictest; uictest.__version__; print({'numpy', 'pydantic'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"


MOTORS = "brake: {dynamic: {force: 60 kN, power: 1.6 MW}}\n"


def test_commands_of_version_2_reduce_the_dynamic_brake_which_does_not_drop(write_scenario):
    rig = uictest.Rig(write_scenario(MOTORS), record=100, contract=2)
    inputs = rig.reset()
    while not rig.stopped:
        rig.step(hold=[0, 0, 0, 1], dynamic_reduction=[0, 1, 0, 0], sand_request=[1, 0, 0, 0])
    assert (inputs.brake_command, inputs.brake_demand) == (1.0, 0.0)
    recording = rig.recording()
    assert recording["dynamic_torque_2"].max() == 0.0
    assert min(recording[f"dynamic_torque_{n}"].max() for n in (1, 3, 4)) > 1000.0
    assert set(recording["sand_request_1"]) == {1.0}
    dropped = uictest.Rig(write_scenario(MOTORS), record=100)
    dropped.reset()
    while not dropped.stopped:
        dropped.step(hold=[0, 0, 0, 1])
    assert dropped.recording()["dynamic_torque_1"].max() == 0.0
    assert [each.result().controller_contract for each in (rig, dropped)] == [2, 1]


def test_what_belongs_to_no_contract_is_refused(write_scenario):
    rig = uictest.Rig(write_scenario(MOTORS), contract=2)
    rig.reset()
    with pytest.raises(ValueError, match=r"^dynamic_reduction\[1\] is 1\.5, expected 0 to 1$"):
        rig.step(dynamic_reduction=[0, 1.5, 0, 0])
    old = uictest.Rig(write_scenario(MOTORS))
    old.reset()
    with pytest.raises(ValueError, match="sand_request belongs to contract version 2"):
        old.step(sand_request=[0, 0, 0, 0])
    for contract in (3, 1.0, True):
        with pytest.raises(ValueError, match=f"contract is {contract}, expected 1 or 2"):
            uictest.Rig(write_scenario(), contract=contract)


def test_a_part_that_waits_for_requests_needs_version_2(write_scenario):
    sander = "sanders: [{wheelset: 3, density: 7.5 g/m, when: requested}]\n"
    outside = 'controller: {connect: "tcp://127.0.0.1:1"}\n'
    path = write_scenario(sander + outside)
    for rig in (uictest.Rig(path), uictest.TrainRig(path)):
        with pytest.raises(ValueError, match=r"can ask for no sander.*: create the rig with contract=2"):
            rig.reset()
    uictest.Rig(path, contract=2).reset()


def test_result_and_recording_state_a_seed_that_is_not_the_scenarios(write_scenario):
    rig = uictest.Rig(write_scenario("simulation: {maximum_duration: 20 s}\n"), record=10)
    for seed, stated in ((5, "5"), (None, None)):
        rig.reset(seed)
        while not rig.stopped:
            rig.step()
        assert rig.result().parameters.get("seed") == stated
        assert rig.recording().metadata.get("seed") == stated


def test_a_request_of_version_2_brings_the_track_brake_where_the_scenario_says_so(write_scenario):
    track = (
        "brake: {track: {attraction: 100 kN, when: requested, delay: 0 s}}\n"
        'controller: {connect: "tcp://127.0.0.1:1"}\n'
    )
    rig = uictest.Rig(write_scenario(track), record=100, contract=2)
    rig.reset()
    while not rig.stopped:
        rig.step(track_brake_request=1)
    assert rig.recording()["track_brake_force"].max() > 40e3
    assert rig.result().measures["track_brake_energy_kj"] > 0.0


JUDGED = "criteria: [uictest-stop]\n"
LOCKING = f"{JUDGED}expect: {{fail: [locked-wheels, total-locked-time, distance-over-reference]}}\n"


def test_a_controller_in_python_is_allowed_what_the_scenario_names_and_nothing_that_it_does_not(
    write_scenario, controller_outside
):
    named = write_scenario(f"{JUDGED}expect: {{fail: [locked-wheels]}}\n")
    result = drive(uictest.Rig(named), controller_outside(load([named])[0]))
    assert (result.outcome, result.met, str(result.expect)) == ("pass", True, "pass or fail (locked-wheels)")
    # Of the scenario's own controller it would be an unexpected pass.
    assert not replace(result, expect=load([named])[0].scenario.expect).met
    unnamed = write_scenario(f"{JUDGED}expect: fail\n")
    result = drive(uictest.Rig(unnamed), controller_outside(load([unnamed])[0]))
    assert (result.met, str(result.expect)) == (True, "pass")


def test_what_a_controller_in_python_misses_within_the_names_is_allowed_and_listed(write_scenario):
    result = drive(uictest.Rig(write_scenario(LOCKING)), _Filling())
    assert (result.outcome, result.met) == ("fail", True)
    assert "locked-wheels" in [each.id for each in result.allowed]
    assert not replace(result, strict=True).met
    beyond = LOCKING.replace("locked-wheels, ", "")
    result = drive(uictest.Rig(write_scenario(beyond)), _Filling())
    assert (result.outcome, result.met, result.allowed) == ("fail", False, ())


class _Filling:
    """A controller that never releases a brake."""

    reference_speed = 0.0

    def magnets(self, wheel_speed):
        return [0] * len(wheel_speed), [0] * len(wheel_speed)
