"""A stop that is stepped from outside is the stop of `run`, to the bit."""

from pathlib import Path

import numpy as np
import pytest

from uictest.controllers import FORBIDDEN_COMMAND, NO_FAILURE, NO_MAGNET_STATE
from uictest.core.record import fields_of
from uictest.plans.scenario import load
from uictest.rig.assembly import assemble
from uictest.rig.backends.stepped import SteppedTrain
from uictest.rig.backends.stops import compiled_rig
from uictest.rig.model.state import Car, Wheelset
from uictest.rig.train_stop import alone, run_to_end

from ...stop_bits import stop_bits

SCENARIOS = Path(__file__).parents[3] / "scenarios"
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


def test_a_copy_of_the_memory_is_a_copy_of_the_stop(rig):
    """It holds no address, so that a tool can go back to an earlier state."""
    stop = SteppedTrain(alone(rig.inputs("rail.condition=wet", "rail.friction=0.06", cycles=60)))
    for _ in range(30):
        stop.step()
    kept = stop.memory.copy()
    ends = []
    for _ in range(2):
        while not stop.has_ended:
            stop.step()
        ends.append(stop.memory.tobytes())
        for name in kept.dtype.names:
            stop.memory[name] = kept[name]
    assert ends[0] == ends[1]
