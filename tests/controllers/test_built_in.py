"""The built-in controllers: what each keeps, which readings are believed, the modes of the threshold."""

from itertools import groupby, pairwise

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.controllers import CONTROLLERS, TrainMemory
from uictest.controllers.built_in.threshold import PROBING
from uictest.core.physics import FILL, HOLD, VENT
from uictest.core.record import fields_of, layout_of
from uictest.plans.scenario import load_part
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.state import CAR, WHEELSET, Car

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


def test_a_flagged_sensor_and_one_that_falls_to_zero_at_once_are_out_of_the_estimate(watching):
    """Whatever it reads: neither the estimate nor the others see anything of it."""
    for reads in (lambda cycle, speed: None, lambda cycle, speed: 0.0 if cycle > 100 else speed):
        controller = watching()
        for _, commands in driven(controller, 500, reads):
            assert commands == [FILL] * 4
        assert controller.reference == pytest.approx(train(499), abs=0.05)


def test_a_wheelset_without_a_speed_gets_the_commands_of_the_other_one_of_its_bogie(watching):
    """A bogie without any speed gets its brake force, also where a wheelset was being vented."""
    controller = watching()
    rows = []
    for cycle in range(300):
        speed, sliding = train(cycle), train(cycle) - 8.0 * CYCLE * cycle
        rows.append(controller.commands_of(max(sliding, 20.0), 0.0, speed, speed, valid=(1, 0, 1, 1)))
    assert VENT in {row[0] for row in rows}
    assert all(row[0] == row[1] for row in rows)
    assert all(row[2:] == [FILL, FILL] for row in rows)
    controller = watching()
    for cycle in range(60):
        speed, sliding = train(cycle), train(cycle) - 8.0 * CYCLE * cycle
        before = controller.commands(sliding, speed, speed, speed)
    assert before[0] != FILL
    for cycle in range(60, 100):
        speed = train(cycle)
        assert controller.commands_of(0.0, 0.0, speed, speed, valid=(0, 0, 1, 1)) == [FILL] * 4


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


def test_a_reading_that_stands_still_while_others_fall_is_distrusted_and_a_single_bad_one_is_not(watching):
    """As the gap of a pole wheel gives one in every turn; all stand still in a train at a steady speed."""
    controller = watching()
    for _, commands in driven(controller, 1000, lambda cycle, speed: speed * (1.0 if cycle % 8 else 0.9)):
        assert commands == [FILL] * 4
    assert controller.wheelsets[1].distrusted == 0
    controller = watching()
    for speed, commands in driven(controller, 1000, lambda cycle, speed: train(min(cycle, 100))):
        assert commands == [FILL] * 4
        assert controller.reference < speed + TRAIN * SHIPPED["stuck_time"] + 0.05
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


def lengths(commands, wanted):
    return [len(list(run)) for command, run in groupby(commands) if command == wanted]


def test_a_wheel_that_falls_faster_than_a_rolling_one_is_vented_before_it_slides_far(threshold_bench):
    """By its deceleration alone, while the slip is still below the threshold."""
    controller = threshold_bench(20.0, slip_threshold=50.0)
    speeds = [20.0 - 20.0 * k * CYCLE for k in range(20)]
    assert VENT in [controller.commands(speed, 20.0, 20.0, 20.0)[0] for speed in speeds]


def test_vent_turns_into_a_hold_while_the_wheel_catches_up_and_into_pulses_afterwards(threshold_bench):
    controller = threshold_bench(20.0)
    down = [20.0 - 8.0 * k * CYCLE for k in range(60)]
    up = [min(down[-1] + 5.0 * k * CYCLE, 20.0) for k in range(300)]
    commands = [controller.commands(speed, 20.0, 20.0, 20.0)[0] for speed in down + up]
    order = [command for command, _ in groupby(commands)]
    assert order[:4] == [FILL, VENT, HOLD, FILL]
    assert commands[-1] == FILL


def test_pressure_returns_in_pulses_of_whole_cycles(threshold_bench):
    """40 ms on and 60 ms off are four and six cycles, each time."""
    controller = threshold_bench(20.0, fill_pulse_on=0.04, fill_pulse_off=0.06, refill_time=3.0)
    for k in range(40):
        controller.commands(20.0 - 8.0 * k * CYCLE, 20.0, 20.0, 20.0)
    commands = [controller.commands(20.0, 20.0, 20.0, 20.0)[0] for _ in range(600)]
    pulses = commands[commands.index(FILL) :]
    assert lengths(pulses[:290], FILL) == [4] * 29
    assert lengths(pulses[:290], HOLD) == [6] * 29
    assert pulses[310:] == [FILL] * len(pulses[310:])


def test_watchdog_ends_a_vent_that_does_not_bring_the_wheel_back(threshold_bench):
    """A wheel that stands although its brake is vented has another fault: the brake comes back."""
    controller = threshold_bench(20.0, vent_watchdog=2.0)
    speeds = [max(20.0 - 10.0 * k * CYCLE, 0.0) for k in range(1500)]
    commands = [controller.commands(speed, 20.0, 20.0, 20.0)[0] for speed in speeds]
    vents = lengths(commands, VENT)
    assert len(vents) > 1
    assert max(vents) <= round(2.0 / CYCLE) + 2


def held(controller, acceleration):
    """Commands to a wheel that falls to a shallow slide and has an acceleration from then on."""
    down = [20.0 - 8.0 * k * CYCLE for k in range(50)]
    after = [down[-1] + acceleration * k * CYCLE for k in range(1, 300)]
    return [controller.commands(speed, 20.0, 20.0, 20.0)[0] for speed in down + after]


def test_a_wheel_that_does_not_catch_up_is_vented_again_when_the_hold_has_lasted_its_limit(threshold_bench):
    """Never before: each whole hold lasts the limit, to a cycle."""
    holds = lengths(held(threshold_bench(20.0, hold_limit=0.5), 0.0), HOLD)
    assert len(holds) > 3
    assert holds[:-1] == [pytest.approx(0.5 / CYCLE, abs=1)] * (len(holds) - 1)


def test_a_wheel_that_gains_speed_is_held_beyond_the_limit(threshold_bench):
    commands = held(threshold_bench(20.0, hold_limit=0.5, reacceleration_threshold=0.4), 0.8)
    assert max(lengths(commands, HOLD)) > 2 * 0.5 / CYCLE
    assert len(lengths(commands, VENT)) == 1


def test_estimate_does_not_sink_with_wheelsets_that_slide_together(threshold_bench):
    """While none rolls it falls at the slow rate, from the cycle in which the last one began to slide."""
    controller = threshold_bench(20.0, holding_deceleration=0.5, sounding_interval=60.0)
    for k in range(500):
        controller.commands(*[max(20.0 - 6.0 * k * CYCLE, 0.0)] * 4)
    seconds_until_all_slide = 0.5
    lowest = 20.0 - 0.5 * 5.0 - 1.8 * seconds_until_all_slide
    assert lowest < controller.reference <= 20.0 - 0.5 * 4.0


def test_one_wheelset_is_released_to_sound_the_speed_and_the_estimate_takes_it_over(threshold_bench):
    """It gains speed, gains no more, and so rolls: its speed is the train's, even where that is lower."""
    controller = threshold_bench(20.0, sounding_interval=1.0)
    for k in range(40):
        controller.commands(*[20.0 - 12.0 * k * CYCLE] * 4)
    slow = 20.0 - 12.0 * 39 * CYCLE
    for _ in range(160):
        controller.commands(slow, slow, slow, slow)
    rising = [min(slow + 5.0 * k * CYCLE, 17.5) for k in range(150)]
    for speed in rising:
        controller.commands(speed, slow, slow, slow)
    assert controller.reference == pytest.approx(17.5, abs=0.2)


SLOWLY = {"holding_deceleration": 0.3, "rolling_time": 0.4, "sounding_interval": 2.0, "sounding_time": 0.6}


def slid(controller, cycles):
    """Let all four wheels fall from 20 m/s to a walking pace and slide on there."""
    for k in range(cycles):
        controller.commands(*[max(20.0 - 12.0 * k * CYCLE, 2.0)] * 4)


def sounded(controller, speeds):
    """Estimates while the first wheelset is released after two seconds of sliding and has these speeds."""
    slid(controller, 200)
    estimates = []
    for speed in speeds:
        controller.commands(speed, 2.0, 2.0, 2.0)
        estimates.append(controller.reference)
    return estimates


def test_a_sounding_lowers_the_estimate_at_most_to_what_the_train_can_have_come_down_to(threshold_bench):
    """A wheel that gains no more may still be slower than any train: it is believed within reason."""
    estimates = sounded(
        threshold_bench(20.0, **SLOWLY), [min(2.0 + 5.0 * k * CYCLE, 4.0) for k in range(100)]
    )
    assert estimates[0] == pytest.approx(20.0 - 0.3 * 2.0, abs=0.02)
    assert min(estimates) < estimates[0] - 3.0
    assert all(estimate >= 20.0 - 1.8 * (200 + k + 1) * CYCLE - 1e-9 for k, estimate in enumerate(estimates))


@pytest.mark.parametrize("acceleration", [3.0, -3.0])
def test_a_released_wheel_that_gains_or_loses_speed_is_not_believed_yet(threshold_bench, acceleration):
    """It does not roll with the train: the estimate goes on falling slowly."""
    estimates = sounded(threshold_bench(20.0, **SLOWLY), [8.0 + acceleration * k * CYCLE for k in range(150)])
    falls = [before - after for before, after in pairwise(estimates)]
    assert falls == pytest.approx([0.3 * CYCLE] * 149)


def test_a_wheel_that_was_just_freed_may_still_slide(threshold_bench):
    """Only after some time is it taken to roll, and the estimate falls as fast as a train can brake."""
    controller = threshold_bench(20.0, **SLOWLY, slip_threshold=50.0, vent_deceleration=1e4)
    estimates = []
    for _ in range(140):
        controller.commands(*[10.0] * 4)
        estimates.append(controller.reference)
    assert estimates[39] == pytest.approx(20.0 - 0.3 * 0.4)
    assert estimates[139] == pytest.approx(estimates[39] - 1.8 * 1.0, abs=0.02)


def test_no_wheelset_is_released_while_one_rolls(threshold_bench):
    """It shows the train's speed itself."""
    controller = threshold_bench(20.0, rolling_time=0.4, sounding_interval=0.5)
    for k in range(400):
        slow = max(20.0 - 12.0 * k * CYCLE, 2.0)
        controller.commands(20.0, slow, slow, slow)
        assert not any(wheelset.mode == PROBING for wheelset in controller.wheelsets)


def test_wheelsets_take_turns_to_sound(threshold_bench):
    """One at a time, each vented until its watchdog, for none is vented long enough to be believed."""
    controller = threshold_bench(
        20.0, sounding_interval=0.5, vent_watchdog=1.0, sounding_time=5.0, holding_deceleration=0.3
    )
    turns = []
    slid(controller, 1)
    for _ in range(800):
        commands = controller.commands(2.0, 2.0, 2.0, 2.0)
        sounding = [i for i in range(4) if controller.wheelsets[i].mode == PROBING]
        assert len(sounding) <= 1
        assert all(commands[i] == VENT for i in sounding)
        turns += sounding
    assert [wheelset for wheelset, _ in groupby(turns)][:5] == [0, 1, 2, 3, 0]


def test_a_dynamic_brake_is_taken_off_before_the_valve_vents_and_comes_back(threshold_bench):
    """While the motor of the sliding wheelset still brakes, its valve holds; the others are left alone."""
    controller = threshold_bench(20.0, refill_time=1.1)
    down = [20.0 - 8.0 * k * CYCLE for k in range(60)]
    answers = []
    for k, speed in enumerate(down + [20.0] * 300):
        dynamic = (1.0, 0.9 if k < 40 else 0.1, 0.5, 0.0)
        command = controller.commands_of(20.0, speed, 20.0, 20.0, valid=(1, 1, 1, 1), dynamic=dynamic)[1]
        answers.append((command, controller.wheelsets[1].dynamic_reduction))
        assert [controller.wheelsets[i].dynamic_reduction for i in (0, 2, 3)] == [0.0, 0.0, 0.0]
    commands, reductions = zip(*answers, strict=True)
    slides = reductions.index(1.0)
    assert set(commands[:slides]) == {FILL}
    assert set(commands[slides:40]) == {HOLD}
    assert commands[40] == VENT
    refilling = reductions.index(0.5)
    assert all(one >= other for one, other in pairwise(reductions[refilling:]))
    assert reductions[refilling + 109] > 0.0
    assert reductions[refilling + 110] == pytest.approx(0.0, abs=1e-12)
    assert answers[-1] == (FILL, 0.0)


speeds = st.lists(st.lists(st.floats(0.0, 60.0), min_size=4, max_size=4), min_size=1, max_size=40)


@given(history=speeds)
def test_any_speeds_give_the_same_commands_and_an_estimate_that_falls_slowly(bench, history):
    """All memory is set at the start: nothing of an earlier stop is left.

    The estimate is never below every wheelset and falls at most at the deceleration of a train, unless a
    wheelset was released to show the speed.
    """
    controller, other = bench(30.0), bench(30.0)
    for measured in history:
        before = controller.reference
        commands = controller.commands(*measured)
        assert all(command in (FILL, HOLD, VENT) for command in commands)
        assert commands == other.commands(*measured)
        assert controller.reference >= max(measured)
        assert controller.reference >= before - 1.8 * CYCLE - 1e-9


def test_a_train_that_brakes_on_a_good_rail_keeps_its_brake_force(bench):
    controller = bench(33.0)
    noise = np.random.default_rng(1).normal(0.0, 5e-4, (2800, 4))
    for k in range(2800):
        rolling = (33.0 - 1.15 * k * CYCLE) * (1.0 + noise[k])
        assert controller.commands(*np.maximum(rolling, 0.0).tolist()) == [FILL] * 4


def test_a_wheelset_that_slides_is_vented_alone_and_gets_its_brake_back(bench):
    controller = bench(20.0)
    commands = []
    for k in range(150):
        speed = 20.0 - 1.0 * k * CYCLE
        commands.append(controller.commands(speed, max(speed - 8.0 * k * CYCLE, 0.0), speed, speed))
    vented = np.array(commands)[:, 1] == VENT
    assert vented[:60].any()
    assert np.all(np.array(commands)[:, [0, 2, 3]] == FILL)
    for _ in range(1000):
        last = controller.commands(*[18.5] * 4)
    assert last == [FILL] * 4


def test_below_a_walking_pace_the_brake_is_left_alone(bench):
    """Locked wheels at a standstill must hold the train."""
    controller = bench(1.0)
    for _ in range(10):
        assert controller.commands(1.0, 0.0, 0.0, 1.0) == [FILL] * 4


def test_fields_of_every_controller_are_in_the_records_and_none_is_a_field_of_the_rig():
    """It would write over what the rig steps, or read what no sensor shows."""
    for controller in CONTROLLERS.values():
        assert issubclass(controller.train_memory, TrainMemory)
        assert fields_of(controller.train_memory).keys() <= set(CAR.names)
        assert fields_of(controller.wheelset_memory).keys() <= set(WHEELSET.names)
        assert fields_of(controller.parameters).keys() <= set(PARAMETERS.names)

    class Greedy(TrainMemory):
        position: float

    with pytest.raises(TypeError, match="'position' is a field of the rig"):
        layout_of(Car, Greedy)
