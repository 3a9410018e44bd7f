"""Speed sensors that count teeth, in a rig whose wheels turn as a test wants."""

import numpy as np
import pytest

from uictest.rig.model.cycle import read_sensors
from uictest.rig.model.records import needs_of

EXACT = {"speed_noise": 0.0, "timer_resolution": 1e-12}
COUNTING = "rig.sensors.speed.method=whole-teeth"
CYCLE = 0.01


class Turning:
    """Readings of wheels with a given speed, cycle by cycle, and the true times and speeds."""

    def __init__(self, bench, speed_at, distance_at, cycles):
        self.times = CYCLE * np.arange(cycles)
        self.speeds = np.array([speed_at(time) for time in self.times])
        self.pitch = bench.wheelsets[0].tooth_pitch
        rows = []
        for cycle, time in enumerate(self.times):
            for wheelset in bench.wheelsets:
                wheelset.rotation = speed_at(float(time)) / wheelset.wheel_radius
                wheelset.angle = distance_at(float(time)) / wheelset.wheel_radius
            bench.car.cycle, bench.car.time = cycle, float(time)
            read_sensors(bench.car, bench.wheelsets, bench.p, needs_of(bench.p))
            rows.append([(w.measured_speed, w.tooth_time) for w in bench.wheelsets])
        self.readings = np.array(rows)[:, :, 0]
        self.ages = self.times[:, None] - np.array(rows)[:, :, 1]


def steady(speed):
    return lambda time: speed, lambda time: speed * time


def braking(speed, deceleration):
    return (lambda t: speed - deceleration * t), (lambda t: speed * t - 0.5 * deceleration * t * t)


def counting(rig, bench, *overrides, **fields):
    return bench(rig.parameters(COUNTING, *overrides, **{**EXACT, **fields})[0])


@pytest.mark.parametrize("speed", [1.0, 3.0, 20.0])
def test_a_steady_speed_is_read_as_it_is(rig, bench, speed):
    turning = Turning(counting(rig, bench), *steady(speed), 200)
    np.testing.assert_allclose(turning.readings, speed, rtol=1e-8)


def test_a_gain_error_is_one_of_every_reading(rig, bench):
    high = "rig.sensors.speed.gain_error=2 %"
    turning = Turning(counting(rig, bench, high), *steady(7.0), 50)
    np.testing.assert_allclose(turning.readings, 7.0 * 1.02, rtol=1e-8)
    momentary = bench(rig.parameters(high, **EXACT)[0])
    read_sensors(momentary.car, momentary.wheelsets, momentary.p, needs_of(momentary.p))
    assert momentary.wheelsets[0].measured_speed == pytest.approx(1.02 * momentary.p.initial_speed, rel=1e-6)


def test_a_braked_wheel_is_read_late_and_later_the_slower_it_turns(rig, bench):
    """The reading is the mean over whole teeth: the true speed half of their duration before the last one."""
    deceleration = 1.5
    turning = Turning(counting(rig, bench), *braking(9.0, deceleration), 560)
    late = (turning.readings - turning.speeds[:, None]) / deceleration
    for wheelset in range(4):
        ages, lag = turning.ages[2:, wheelset], late[2:, wheelset]
        # Whole teeth took no less than one pitch and end within `age` of the reading.
        pitch_time = turning.pitch / turning.readings[2:, wheelset]
        assert np.all(lag >= ages + 0.5 * pitch_time - 1e-6)
        assert np.all(lag <= ages + 0.5 * (CYCLE + pitch_time) + 1e-6)
    fast, slow = late[20:60].mean(), late[500:].mean()
    assert 0.004 < fast < 0.012
    assert slow > 3.0 * fast


def test_a_wheel_that_stands_is_read_as_before_until_the_time_of_the_slowest_tooth(rig, bench):
    lock = 0.1
    turning = Turning(
        counting(rig, bench, "rig.sensors.speed.minimum_speed=1 km/h"),
        lambda time: 5.0 if time <= lock else 0.0,
        lambda time: 5.0 * min(time, lock),
        60,
    )
    silent_after = turning.pitch / (1.0 / 3.6)
    for wheelset in range(4):
        silent = turning.readings[:, wheelset] == 0.0
        np.testing.assert_array_equal(silent, turning.ages[:, wheelset] > silent_after)
        assert silent.any()


def test_an_eccentric_wheel_errs_by_nothing_over_a_turn(rig, bench):
    eccentric = "rig.sensors.speed.eccentricity=2 %"
    radius = rig.parameters()[0].wheel_radius
    speed = 2.0 * np.pi * radius / (100 * CYCLE)  # a turn takes a hundred cycles
    for overrides, accuracy in (((COUNTING, eccentric), 5e-5), ((eccentric,), 1e-6)):
        turning = Turning(bench(rig.parameters(*overrides, **EXACT)[0]), *steady(speed), 301)
        errors = turning.readings[101:301] / speed - 1.0
        np.testing.assert_allclose(errors.mean(axis=0), 0.0, atol=accuracy)
        np.testing.assert_allclose(errors.max(axis=0), 0.02, rtol=0.02)
        np.testing.assert_allclose(errors.min(axis=0), -0.02, rtol=0.02)


def test_a_missing_tooth_reads_low_once_per_turn(rig, bench):
    """A cycle in which five pitches pass then counts four of them."""
    p = rig.parameters(COUNTING, "rig.sensors.speed.teeth=80")[0]
    pitches = 5.0
    turning = Turning(
        counting(rig, bench, "rig.sensors.speed.teeth=80", "rig.sensors.speed.missing_teeth=1"),
        *steady(pitches * p.tooth_pitch / CYCLE),
        161,
    )
    relative = turning.readings[1:] / turning.speeds[0]
    low = relative < 1.0 - 1e-6
    np.testing.assert_array_equal(low.sum(axis=0), 160 * pitches / 80)
    np.testing.assert_allclose(relative[~low], 1.0, rtol=1e-6)
    # The lost tooth may end a cycle: then the interval is short of a pitch and the next one has it more.
    lost = np.sort(np.unique(np.round(relative[low], 6)))
    assert set(lost) <= {round((pitches - 1.0) / pitches, 6), round(pitches / (pitches + 1.0), 6)}


def test_the_angle_is_the_integral_of_the_rotation(rig):
    stop = rig.stop("rail.condition=wet", "rail.friction=0.05", every=1, cycles=300)
    radius = rig.parameters()[0].wheel_radius
    turned = np.trapezoid(stop.trace.wheelsets["wheel_speed"] / radius, dx=5e-4, axis=0)
    np.testing.assert_allclose(stop.wheelsets["angle"], turned, rtol=1e-9)


def test_pole_wheels_do_not_begin_at_the_same_angle(rig, bench):
    turning = Turning(counting(rig, bench), *steady(1.0), 2)
    assert len(set(turning.ages[1])) == 4


def test_one_wheelset_can_have_another_sensor(rig):
    own = "vehicle.wheelsets.3.sensors.speed.method=whole-teeth"
    one, other = (rig.columns(*each, every=20, cycles=60, **EXACT) for each in ((), (own,)))
    same = (one["measured_speed"] == other["measured_speed"]).all(axis=0)
    assert list(same) == [True, True, False, True]
