"""The course of the brake command over time, release, and stops that end above standstill."""

import numpy as np
import pytest

from ..stop_bits import bits

BYPASSED = ("rig.wsp=bypassed", "rig.topology=four-caliper")
SERVICE = "brake.command=[{at: 0 s, value: 60 %}, {at: 4 s, value: 100 %, position: emergency}]"
RELEASED = "brake.command=[{at: 0 s, value: 100 %}, {at: 6 s, value: 0 %}]"
AGAIN = "brake.command=[{at: 0 s, value: 100 %}, {at: 5 s, value: 0 %}, {at: 9 s, value: 80 %}]"
STEPS_PER_SECOND = 2000


def position(rig, name="R"):
    return rig.case().scenario.brake.system.positions[name]


def test_a_course_of_one_command_is_that_command(rig):
    alone = rig.stop("brake.command=60 %")
    assert bits(rig.stop("brake.command=[{at: 0 s, value: 60 %}]")) == bits(alone)
    repeated = "brake.command=[{at: 0 s, value: 60 %}, {at: 7 s, value: 60 %}]"
    assert rig.stop(repeated).measures.braking_distance == alone.measures.braking_distance


def test_every_command_begins_a_ramp_after_its_dead_time_at_the_rate_of_its_position(rig):
    stop = rig.columns(SERVICE, every=1)
    service, emergency = position(rig), position(rig, "emergency")
    times, demanded = stop["time"], stop["demanded_pressure"]
    begins = 4.0 + emergency.dead_time
    ends = begins + (emergency.maximum_pressure - 0.6 * service.maximum_pressure) / (
        emergency.maximum_pressure / emergency.fill_time
    )
    low, high = 0.6 * service.maximum_pressure, emergency.maximum_pressure
    first = np.clip((times - service.dead_time) / service.fill_time, 0.0, 1.0) * low
    expected = np.where(times < begins, first, np.interp(times, [begins, ends], [low, high]))
    # A sample shows the demand of the step before it; its ramp takes effect with a controller cycle.
    largest = high / emergency.fill_time / STEPS_PER_SECOND
    assert np.abs(demanded - expected)[1:].max() < 1.01 * largest + 0.01 * high / emergency.fill_time


def test_a_released_brake_falls_in_its_release_time(rig):
    release = "brake.system.positions.R.release_time=2 s"
    stop = rig.columns(RELEASED, release, "simulation.maximum_duration=15 s", every=1)
    begins = 6.0 + position(rig).dead_time
    fallen = np.interp(begins + 1.0, stop["time"], stop["demanded_pressure"])
    assert fallen == pytest.approx(0.5 * position(rig).maximum_pressure, rel=0.01)
    gone = stop["time"] > begins + 2.01
    assert np.all(stop["demanded_pressure"][gone] == 0.0)


def test_a_released_train_rolls_under_its_running_resistance_alone(rig):
    stop = rig.columns(RELEASED, *BYPASSED, "simulation.maximum_duration=30 s")
    rolls = stop["time"] > 20.0
    # The rig brakes with what its loadcells show: noise and resolution, some ten newtons.
    shown = stop["brake_torque"][rolls].sum(axis=1).mean() / 0.43
    assert shown < 100.0
    resistance = rig.case().scenario.vehicle.running_resistance
    speed = stop["speed"][rolls].mean()
    drag = resistance.constant + resistance.linear * speed + resistance.quadratic * speed**2
    mass = rig.case().scenario.vehicle.total_mass + 4.0 * 123.0 / 0.43**2
    falls = (stop["speed"][rolls][0] - stop["speed"][-1]) / (stop["time"][-1] - stop["time"][rolls][0])
    assert falls == pytest.approx((drag + shown) / mass, rel=0.01)


def test_release_lets_a_locked_wheelset_roll_again(rig):
    stop = rig.columns(
        *(RELEASED, *BYPASSED, "rail.condition=wet", "rail.friction=0.08", "initial_speed=120 km/h"),
        "simulation.maximum_duration=45 s",
    )
    locked = (stop["time"] > 5.0) & (stop["time"] < 6.0)
    assert np.all(stop["wheel_speed"][locked] == 0.0)
    assert stop["slide"][-1].max() < 0.01


def test_a_command_that_a_later_one_overtakes_never_takes_effect(rig):
    """Its position needs longer: the train would brake again after its release."""
    slow = ("brake.system.positions.G={maximum_pressure: 3.8 bar, fill_time: 20 s, dead_time: 5 s}",)
    course = (
        "brake.command=[{at: 0 s, value: 50 %}, {at: 1 s, value: 100 %, position: G}, {at: 2 s, value: 0 %}]"
    )
    stop = rig.columns(course, *slow, *BYPASSED)
    assert stop["demanded_pressure"][stop["time"] > 4.0].max() == 0.0


def test_controllers_see_the_command_when_it_is_given_and_never_more_than_all(rig):
    inputs = rig.inputs(SERVICE)
    p = inputs.parameters
    assert (p.first_command, p.command_shares[1], p.command_given[1]) == (0.6, 1.0, 4.0)
    assert p.command_times[1] == 4.0 + position(rig, "emergency").dead_time
    assert p.command_pressures[1] * p.demand_per_pressure == pytest.approx(1.0)


def test_a_released_train_has_its_dynamic_brake_again(rig):
    course = "brake.command=[{at: 0 s, value: 100 %}, {at: 5 s, value: 0 %}, {at: 9 s, value: 60 %}]"
    stop = rig.columns(
        course,
        *("brake.dynamic={force: 60 kN, power: 1.6 MW}", "controller=slip-band", "initial_speed=120 km/h"),
        "rail.condition=wet",
        "rail.friction={points: [{position: 0 m, friction: 0.06}, {position: 250 m, friction: 0.3}]}",
    )
    dropped = (stop["time"] > 4.0) & (stop["time"] < 5.0)
    assert stop["dynamic_torque"][dropped].max() < 1e-3 * stop["dynamic_torque"].max()
    assert stop["dynamic_torque"][(stop["time"] > 11.0) & (stop["speed"] > 5.0)].max() > 1000.0


def test_the_build_up_is_that_of_the_first_application(rig):
    alone = rig.stop("brake.command=100 %", *BYPASSED).measures.build_up_time
    assert rig.stop(RELEASED, *BYPASSED, "simulation.maximum_duration=30 s").measures.build_up_time == alone
    early = "brake.command=[{at: 0 s, value: 100 %}, {at: 0.2 s, value: 50 %}]"
    assert np.isnan(rig.stop(early).measures.build_up_time)


@pytest.mark.parametrize("until", ["30 km/h", "5 km/h"])
def test_a_stop_until_a_speed_is_the_beginning_of_the_whole_stop(rig, until):
    rail = ("rail.condition=wet", "rail.friction=0.10")
    whole, part = rig.columns(*rail), rig.columns(*rail, f"until={until}")
    rows = len(part["time"]) - 1
    assert np.array_equal(part["speed"][:rows], whole["speed"][:rows])
    speed = float(until.split()[0]) / 3.6
    measures = rig.stop(*rail, f"until={until}").measures
    assert measures.stopped == 0.0
    assert speed - 0.02 < measures.end_speed <= speed  # it ends with a controller cycle
    order = slice(None, None, -1)
    for name, found in (("time", measures.end_time), ("distance", measures.end_distance)):
        expected = np.interp(speed, whole["speed"][order], whole[name][order])
        assert found == pytest.approx(expected, rel=1e-3)


def test_nothing_slides_at_the_end_of_a_stop_until_a_speed_that_did_not_before(rig):
    """Train and wheels are seen at the same instant."""
    whole, part = rig.columns(*BYPASSED, every=20), rig.stop(*BYPASSED, "until=20 km/h")
    slides = whole["slide"][whole["speed"] > 20.0 / 3.6]
    assert part.wheelset_measures.maximum_slide.max() <= slides.max() + 1e-6


def test_what_is_of_a_standstill_does_not_apply_to_a_stop_that_ends_above(rig):
    result, verdicts = rig.judged("until=10 km/h", "criteria=uictest-stop")
    for name in ("standstill", "distance-over-reference"):
        assert verdicts[name].status == "not_applicable"
        assert verdicts[name].reason == "the stop ends at 10 km/h, above standstill"
    assert result.outcome == "pass"
    assert np.isnan(result.measures["braking_distance_m"])


def test_a_stop_that_ends_before_it_has_shown_to_be_a_test_is_none(rig):
    """Sliding counts down to 60 km/h; whether it would have sufficed lies behind the end of the stop."""
    result, verdicts = rig.judged(
        *("until=70 km/h", "initial_speed=120 km/h", "rail.condition=wet", "rail.friction=0.09"),
        "criteria=uic-541-05-appendix-b",
    )
    slide = verdicts["minimum-slide"]
    assert (slide.status, result.outcome) == ("inconclusive", "inconclusive")
    assert "the stop ends at 70 km/h" in slide.reason


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        (
            [AGAIN, "initial_speed=120 km/h"],
            "no stop at a brake command of one application (it is a course of several)",
        ),
        (
            ["until=10 km/h", "initial_speed=80 km/h"],
            "no stop from 120 km/h (it is 80 km/h, tolerance 3 km/h)",
        ),
    ],
    ids=["course", "speed"],
)
def test_a_profile_cannot_judge_what_command_or_speed_keep_from_being_its_test(rig, settings, reason):
    result, verdicts = rig.judged(*settings, "criteria=uic-541-05-appendix-b")
    distance = verdicts["braking-distance"]
    assert (distance.status, distance.reason) == ("inconclusive", reason)
    assert (result.outcome, result.reason) == ("inconclusive", f"braking-distance: {reason}")
