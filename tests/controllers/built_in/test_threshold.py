"""The threshold controller: its modes, its watchdog and its estimate of the train's speed."""

from itertools import groupby, pairwise

import pytest

from uictest.controllers.built_in.threshold import PROBING
from uictest.core.physics.air import FILL, HOLD, VENT

CYCLE = 0.01


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
