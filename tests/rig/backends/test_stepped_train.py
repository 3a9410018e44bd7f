"""A train that is stepped from outside is the train of `run`, and a train of one car the car alone."""

import numpy as np
import pytest

from uictest.rig.backends.stepped import SteppedTrain
from uictest.rig.coupled_cars import run_coupled
from uictest.rig.train_inputs import assemble_train

from ...stop_bits import stop_bits
from .trains_in_lanes import CLEANED, COUPLED, LOOSE, MAGNETS, OTHER, PIPED, SANDER, WET

SLOW = "initial_speed=20 km/h"
TRAINS = {
    "cleaned rail": (COUPLED, CLEANED, [(), ("brake.command=60 %",), ()]),
    "cars that stop one after another": (LOOSE, CLEANED, [("brake.command=40 %",), ()]),
    "pipe, sand": (PIPED, CLEANED, [(), (SANDER,), ("brake.command=80 %", OTHER)]),
    "magnets": (PIPED, WET, [(MAGNETS,), (MAGNETS, "brake.command=60 %")]),
    "another controller": (COUPLED, (*WET, "until=6 km/h"), [("controller=slip-band",), ()]),
    "its longest duration": (
        COUPLED,
        (*WET, "simulation.maximum_duration=20 s"),
        [("rig.wsp=bypassed",), ()],
    ),
}


def cases_of(rig, shared, cars):
    return [rig.case(SLOW, *shared, *own) for own in cars]


def drive(stop, controllers):
    """Step a train to its end with a controller outside for each car."""
    while not stop.has_ended:
        for inputs, outputs, controller in zip(stop.inputs, stop.outputs, controllers, strict=True):
            outputs["hold"], outputs["vent"] = controller.magnets(inputs["wheel_speed"].tolist())
            outputs["reference_speed"] = controller.reference_speed
        stop.step()
    return stop.finished()


@pytest.mark.parametrize("name", TRAINS)
def test_a_train_has_the_bits_of_run(rig, controller_outside, name):
    coupling, shared, cars = TRAINS[name]
    cases = cases_of(rig, shared, cars)
    stop = SteppedTrain(assemble_train(cases, coupling), 7)
    stepped = drive(stop, [controller_outside(case) for case in cases])
    run = run_coupled(cases, coupling, 7)
    assert stop.memory["couplers"].tobytes() == run.couplers.tobytes()
    for ours, theirs in zip(stepped, run.cars, strict=True):
        one, other = (stop_bits(each.measures, each.wheelset_measures) for each in (ours, theirs))
        assert one == other
        for one, other in zip(ours.trace, theirs.trace, strict=True):
            assert one.tobytes() == other.tobytes()


@pytest.mark.parametrize("car", [0, 2])
def test_a_command_that_no_valve_has_moves_no_car(rig, car):
    cases = cases_of(rig, CLEANED, [(), (), ()])
    stop, other = (SteppedTrain(assemble_train(cases, COUPLED)) for _ in range(2))
    for each in (stop, other):
        each.step()
    stop.outputs[car]["vent"][1] = 1
    stop.outputs[1]["hold"] = 1
    stop.step()
    assert [bool(each["failure"]) for each in stop.memory["exchange"]] == [place == car for place in range(3)]
    assert stop.memory["exchange"][car]["failed_wheelset"] == 1
    assert stop.memory["train"].tobytes() == other.memory["train"].tobytes()
    for outputs in stop.outputs:
        outputs["hold"], outputs["vent"] = 0, 0
    for each in (stop, other):
        for _ in range(50):
            each.step()
    for name in set(stop.memory.dtype.names) - {"exchange"}:  # which says what was refused last
        assert stop.memory[name].tobytes() == other.memory[name].tobytes()


def test_a_copy_of_the_memory_is_a_copy_of_the_stop(rig):
    stop = SteppedTrain(assemble_train(cases_of(rig, CLEANED, [(), ("brake.command=50 %",)]), COUPLED))
    for _ in range(100):
        stop.step()
    kept = stop.memory.copy()
    ends = []
    for _ in range(2):
        for name in kept.dtype.names:
            stop.memory[name] = kept[name]
        for _ in range(60):
            stop.step()
        ends.append(stop.memory.tobytes())
    assert ends[0] == ends[1] != kept.tobytes()


def test_a_car_that_stands_is_asked_until_all_cars_stand(rig):
    stop = SteppedTrain(assemble_train(cases_of(rig, WET, [("brake.command=40 %",), ()]), LOOSE))
    stood = 0
    while not stop.has_ended:
        stop.step()
        cycles = [int(inputs["cycle"]) for inputs in stop.inputs]
        assert cycles[0] == cycles[1]
        if stop.memory["car"]["closed"][1] and not stop.has_ended:
            stood += 1
            assert stop.inputs[1]["wheel_speed"].max() < 0.1
    assert stood > 100
    assert np.all(stop.memory["measures"]["end_speed"] == 0.0)
