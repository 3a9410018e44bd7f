"""What every controller keeps: the benches hold nothing that a controller must not see."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.controllers import CONTROLLERS, TrainMemory
from uictest.core.physics.air import FILL, HOLD, VENT
from uictest.core.record import fields_of, layout_of
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.state import CAR, WHEELSET, Car

CYCLE = 0.01
speeds = st.lists(st.lists(st.floats(0.0, 60.0), min_size=4, max_size=4), min_size=1, max_size=40)


@given(history=speeds)
def test_any_speeds_give_each_wheelset_a_command(bench, history):
    controller = bench(30.0)
    for measured in history:
        assert all(command in (FILL, HOLD, VENT) for command in controller.commands(*measured))


@given(history=speeds)
def test_the_same_speeds_give_the_same_commands(bench, history):
    """All memory is set at the start: nothing of an earlier stop is left."""
    one, other = bench(30.0), bench(30.0)
    assert [one.commands(*s) for s in history] == [other.commands(*s) for s in history]


@given(history=speeds)
def test_reference_speed_is_never_below_every_wheelset_and_falls_slowly(bench, history):
    """At most at the deceleration of a train, unless a wheelset was released to show the speed."""
    controller = bench(30.0)
    fall = 1.8 * CYCLE
    for measured in history:
        before = controller.reference
        controller.commands(*measured)
        assert controller.reference >= max(measured)
        assert controller.reference >= min(before, before - fall) - 1e-9


def test_a_train_that_brakes_on_a_good_rail_keeps_its_brake_force(bench):
    controller = bench(33.0)
    noise = np.random.default_rng(1).normal(0.0, 5e-4, (2800, 4))
    for k in range(2800):
        rolling = (33.0 - 1.15 * k * CYCLE) * (1.0 + noise[k])
        assert controller.commands(*np.maximum(rolling, 0.0).tolist()) == [FILL] * 4


def test_a_wheelset_that_slides_is_vented_and_the_others_are_not(bench):
    controller = bench(20.0)
    commands = []
    for k in range(150):
        speed = 20.0 - 1.0 * k * CYCLE
        commands.append(controller.commands(speed, max(speed - 8.0 * k * CYCLE, 0.0), speed, speed))
    vented = np.array(commands)[:, 1] == VENT
    assert vented[:60].any()
    assert np.all(np.array(commands)[:, [0, 2, 3]] == FILL)


def test_a_wheelset_that_rolls_again_gets_its_brake_back(bench):
    controller = bench(20.0)
    for k in range(100):
        controller.commands(20.0, max(20.0 - 8.0 * k * CYCLE, 0.0), 20.0, 20.0)
    for _ in range(1000):
        commands = controller.commands(20.0, 20.0, 20.0, 20.0)
    assert commands == [FILL] * 4


def test_below_a_walking_pace_the_brake_is_left_alone(bench):
    """Locked wheels at a standstill must hold the train."""
    controller = bench(1.0)
    for _ in range(10):
        assert controller.commands(1.0, 0.0, 0.0, 1.0) == [FILL] * 4


def test_reference_speed_is_recorded_from_the_memory_that_every_controller_has():
    assert all(issubclass(controller.train_memory, TrainMemory) for controller in CONTROLLERS.values())


def test_fields_of_every_controller_are_in_the_records():
    for controller in CONTROLLERS.values():
        assert fields_of(controller.train_memory).keys() <= set(CAR.names)
        assert fields_of(controller.wheelset_memory).keys() <= set(WHEELSET.names)
        assert fields_of(controller.parameters).keys() <= set(PARAMETERS.names)


def test_a_controller_cannot_take_a_field_of_the_rig():
    """It would write over what the rig steps, or read what no sensor shows."""

    class Greedy(TrainMemory):
        position: float

    with pytest.raises(TypeError, match="'position' is a field of the rig"):
        layout_of(Car, Greedy)
