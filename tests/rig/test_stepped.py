"""A stop that is stepped from outside is the stop of `run`, to the bit."""

from pathlib import Path

import numpy as np
import pytest

from uictest.controllers import FORBIDDEN_COMMAND, NO_FAILURE, NO_MAGNET_STATE
from uictest.core.record import fields_of
from uictest.plans.scenario import load
from uictest.rig.assembly import assemble
from uictest.rig.model.state import Car, Wheelset
from uictest.rig.simulation import run_coupled
from uictest.rig.stepped import SteppedTrain
from uictest.rig.train_assembly import assemble_train
from uictest.rig.train_stop import alone, compiled_rig, run_to_end

from ..stop_bits import stop_bits
from .trains_in_lanes import CLEANED, COUPLED, LOOSE, MAGNETS, OTHER, PIPED, SANDER, WET

SCENARIOS = Path(__file__).parents[2] / "scenarios"
OF_THE_NEXT_CYCLE = {
    *("measured_speed", "pressure_error", "loadcell_error", "line_pressure_error", "friction"),
    *("pad_friction", "last_tooth", "tooth_time", "tooth_rate", "tooth_speed", "cleaned_share"),
    "sand_density",
}
"""What the sensors and the look-ups after the last cycle set."""
VARIANTS = {
    "modelled air": ("slide-80.yaml", ["rig.compensation=thermal"]),
    "pole wheels": ("low-adhesion-80.yaml", ["rig.sensors=pole-wheel"]),
    "slip band": ("slide-80-four-caliper.yaml", ["controller=slip-band"]),
    "another cycle": ("low-adhesion-80.yaml", ["controller.cycle_time=20 ms"]),
    "a sander": ("sanded-80.yaml", []),
}


def stepped_to_end(case, outside, every):
    stop, controller = SteppedTrain(alone(assemble(case)), every), outside(case)
    [exchange] = stop.memory["exchange"]
    while not stop.has_ended:
        exchange["hold"], exchange["vent"] = controller.magnets(exchange["wheel_speed"].tolist())
        exchange["reference_speed"] = controller.reference_speed
        stop.step()
    [finished] = stop.finished()
    return finished


def assert_same(stepped, run):
    """Every measure, every sample and every state but those of the cycle that never came."""
    ours, theirs = (stop_bits(each.measures, each.wheelset_measures) for each in (stepped, run))
    assert ours == theirs
    for one, other in zip(stepped.trace, run.trace, strict=True):
        assert one.tobytes() == other.tobytes()
    memory_of_controller = {*run.car.dtype.names, *run.wheelsets.dtype.names} - own_states()
    for one, other in ((stepped.car, run.car), (stepped.wheelsets, run.wheelsets)):
        differ = {name for name in one.dtype.names if one[name].tobytes() != other[name].tobytes()}
        assert differ <= OF_THE_NEXT_CYCLE | memory_of_controller


def own_states():
    """States of the rig and what any controller shows of itself."""
    return {*fields_of(Car), *fields_of(Wheelset)}


def assert_bits_of_run(case, outside, every):
    run = run_to_end(compiled_rig(), assemble(case), every)
    assert_same(stepped_to_end(case, outside, every), run)


def test_every_shipped_stop_has_the_bits_of_run(scenarios, controller_outside):
    single = [case for case in scenarios if case.train is None]
    for number, case in enumerate(single):
        assert_bits_of_run(case, controller_outside, every=0 if number % 5 else 7)


@pytest.mark.parametrize("name", VARIANTS)
def test_other_parts_of_the_rig_have_the_bits_of_run(name, controller_outside):
    file, overrides = VARIANTS[name]
    assert_bits_of_run(load([SCENARIOS / file], overrides)[0], controller_outside, every=20)


def test_a_stop_ends_after_its_longest_duration(rig):
    inputs = rig.inputs("rig.wsp=bypassed", cycles=50)
    stop, steps = SteppedTrain(alone(inputs)), 0
    while not stop.has_ended:
        stop.step()
        steps += 1
    assert steps == 50
    run = run_to_end(compiled_rig(), inputs)
    ours, theirs = (stop_bits(each.measures, each.wheelset_measures) for each in (*stop.finished(), run))
    assert ours == theirs


def test_the_present_state_is_that_of_the_recording(rig):
    """Sampled at the end of each cycle, after the sensors were read for the next one."""
    inputs = rig.inputs("rail.condition=wet", "rail.friction=0.06", cycles=150)
    steps = int(inputs.parameters["steps_per_cycle"])
    stop = SteppedTrain(alone(inputs), steps)
    states = [stop.memory["train"].copy()]
    while not stop.has_ended:
        stop.step()
        states.append(stop.memory["train"].copy())
    recorded = stop.finished()[0].trace.train
    for name in ("time", "distance", "speed", "brake_line_pressure"):
        assert np.concatenate(states)[name].tobytes() == recorded[name].tobytes()


@pytest.mark.parametrize(
    ("hold", "vent", "failure"),
    [(0, 1, FORBIDDEN_COMMAND), (2, 0, NO_MAGNET_STATE), (0, -1, NO_MAGNET_STATE)],
)
def test_a_command_that_no_valve_has_moves_nothing(rig, hold, vent, failure):
    stop, other = (SteppedTrain(alone(rig.inputs(cycles=20))) for _ in range(2))
    stop.memory["exchange"][0]["hold"][2], stop.memory["exchange"][0]["vent"][2] = hold, vent
    stop.step()
    assert stop.memory["exchange"][0]["failure"] == failure
    assert stop.memory["exchange"][0]["failed_wheelset"] == 2
    stop.memory["exchange"][0]["hold"], stop.memory["exchange"][0]["vent"] = 0, 0
    for each in (stop, other):
        while not each.has_ended:
            each.step()
    assert stop.memory["exchange"][0]["failure"] == NO_FAILURE
    assert stop.finished()[0].measures.tobytes() == other.finished()[0].measures.tobytes()


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


@pytest.mark.parametrize("cars", [[()], [(), ("brake.command=50 %",)]], ids=["alone", "train"])
def test_a_copy_of_the_memory_is_a_copy_of_the_stop(rig, cars):
    """It holds no address, so that a tool can go back to an earlier state."""
    stop = SteppedTrain(assemble_train(cases_of(rig, CLEANED, cars), COUPLED))
    for _ in range(100):
        stop.step()
    kept, ends = stop.memory.copy(), []
    for _ in range(2):
        for name in kept.dtype.names:
            stop.memory[name] = kept[name]
        while not stop.has_ended:
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
