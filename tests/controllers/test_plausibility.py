"""Which readings the threshold controller believes, and what becomes of a wheelset without a speed."""

from itertools import groupby

import pytest

from uictest.core.physics import FILL, VENT
from uictest.plans.scenario import load_part

CYCLE = 0.01
NAMES = ("largest_acceleration", "jump_tolerance", "distrust_time", "stuck_time", "trust_time")
SHIPPED = {name: float(getattr(load_part("controllers/threshold"), name)) for name in NAMES}
TRAIN = 1.0
"""Deceleration of the train in these tests, m/s2."""


@pytest.fixture(name="watching")
def _watching(threshold_bench):
    """A bench with the shipped controller at 30 m/s."""
    return lambda **changes: threshold_bench(30.0, **{**SHIPPED, **changes})


def train(cycle):
    return 30.0 - TRAIN * CYCLE * cycle


def driven(controller, cycles, reads):
    """Yield the train's speed and the commands of each cycle; the second sensor says nothing where None."""
    for cycle in range(cycles):
        speed = train(cycle)
        read = reads(cycle, speed)
        speeds = (speed, 60.0 if read is None else read, speed, speed)
        yield speed, controller.commands_of(*speeds, valid=(1, int(read is not None), 1, 1))


def test_a_flagged_sensor_is_out_of_the_estimate_at_once(watching):
    """Whatever it reads: neither the estimate nor the others see anything of it."""
    controller = watching()
    for _, commands in driven(controller, 500, lambda cycle, speed: None):
        assert commands == [FILL] * 4
    assert controller.reference == pytest.approx(train(499), abs=0.05)


def test_a_wheelset_without_a_speed_gets_the_commands_of_the_other_one_of_its_bogie(watching):
    controller = watching()
    rows = []
    for cycle in range(300):
        speed, sliding = train(cycle), train(cycle) - 8.0 * CYCLE * cycle
        rows.append(controller.commands_of(max(sliding, 20.0), 0.0, speed, speed, valid=(1, 0, 1, 1)))
    assert VENT in {row[0] for row in rows}
    assert all(row[0] == row[1] for row in rows)
    assert all(row[2:] == [FILL, FILL] for row in rows)


def test_a_bogie_without_any_speed_gets_its_brake_force(watching):
    """Also where one of them was being vented when its sensor failed."""
    controller = watching()
    for cycle in range(60):
        speed, sliding = train(cycle), train(cycle) - 8.0 * CYCLE * cycle
        before = controller.commands(sliding, speed, speed, speed)
    assert before[0] != FILL
    for cycle in range(60, 100):
        speed = train(cycle)
        assert controller.commands_of(0.0, 0.0, speed, speed, valid=(0, 0, 1, 1)) == [FILL] * 4


def test_a_reading_that_falls_to_zero_at_once_is_no_lock(watching):
    for _, commands in driven(watching(), 500, lambda cycle, speed: 0.0 if cycle > 100 else speed):
        assert commands == [FILL] * 4


def test_a_wheel_that_locks_as_fast_as_a_brake_can_is_vented(watching):
    controller = watching()
    locking = driven(controller, 200, lambda cycle, speed: max(30.0 - 25.0 * CYCLE * cycle, 0.0))
    commands = [all_four[1] for _, all_four in locking]
    assert [command for command, _ in groupby(commands)][:2] == [FILL, VENT]
    assert commands.index(VENT) * CYCLE < 0.2


@pytest.mark.parametrize(
    ("reads", "excess"),
    [
        (lambda cycle, speed: speed + 6.0 if cycle > 100 else speed, 0.05),
        (lambda cycle, speed: speed + (-8.0, 5.0, 8.0, -5.0, 2.0)[cycle % 5], 2.1),
    ],
    ids=["up and stays there", "up and down"],
)
def test_readings_that_jump_do_not_raise_the_estimate(watching, reads, excess):
    """Some of them are plausible after others; while there is doubt, none counts."""
    controller = watching()
    for speed, _ in driven(controller, 500, reads):
        assert controller.reference < speed + excess
    assert controller.wheelsets[1].distrusted == 1


def test_a_single_bad_reading_does_nothing(watching):
    """As the gap of a pole wheel gives one in every turn."""
    controller = watching()
    for _, commands in driven(controller, 1000, lambda cycle, speed: speed * (1.0 if cycle % 8 else 0.9)):
        assert commands == [FILL] * 4
    assert controller.wheelsets[1].distrusted == 0


def test_a_reading_that_stands_still_while_others_fall_is_distrusted(watching):
    controller = watching()
    for speed, commands in driven(controller, 1000, lambda cycle, speed: train(min(cycle, 100))):
        assert commands == [FILL] * 4
        assert controller.reference < speed + TRAIN * SHIPPED["stuck_time"] + 0.05


def test_a_train_at_a_steady_speed_has_no_stuck_sensor(watching):
    controller = watching()
    for _ in range(300):
        controller.commands(*[30.0] * 4)
    assert [each.distrusted for each in controller.wheelsets] == [0] * 4


def test_a_sensor_that_comes_back_is_trusted_after_a_while(watching):
    controller = watching()
    cycles = driven(controller, 600, lambda cycle, speed: None if 100 <= cycle < 200 else speed)
    distrusted = [controller.wheelsets[1].distrusted for _ in cycles]
    first, last = distrusted.index(1), len(distrusted) - distrusted[::-1].index(1)
    assert first == 100
    assert last == pytest.approx(200 + SHIPPED["trust_time"] / CYCLE, abs=2)


def test_wheelsets_without_a_speed_are_not_probed(watching):
    """All others slide together: one of them is released to find the train's speed."""
    controller = watching(sounding_interval=0.5)
    probed = set()
    for cycle in range(900):
        speed = max(30.0 - 8.0 * CYCLE * cycle, 10.0) + 1e-3 * (cycle % 3)
        controller.commands_of(0.0, speed, speed, speed, valid=(0, 1, 1, 1))
        probed.add(controller.train.probed)
    assert probed - {3} == {1, 2}
