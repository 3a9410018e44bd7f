"""Faults of valves, brakes and sensors as a controller outside meets them."""

import numpy as np
import pytest

import uictest
from uictest.core.units import BAR

NOTHING, HOLD, VENT = ([0] * 4, [0] * 4), ([1] * 4, [0] * 4), ([1] * 4, [1] * 4)
HALF_FULL = 45
"""Cycles until the tanks are about half full."""
FILLED = 100
"""Cycles until they are full."""


class Stop:
    """A stop whose four valves are commanded alike."""

    def __init__(self, path, fault=""):
        self.rig = uictest.Rig(path)
        self.inputs = [self.rig.reset()]

    def command(self, magnets, cycles):
        """Return the tank pressures before and after these cycles, bar."""
        before = self.rig.state.tank_pressure
        for _ in range(cycles):
            self.inputs.append(self.rig.step(hold=magnets[0], vent=magnets[1]))
        return np.array([before, self.rig.state.tank_pressure]) / BAR


@pytest.fixture
def stop(write_scenario):
    """Begin a stop with one fault of wheelset 2 or of the train, or with none."""
    return lambda fault: Stop(write_scenario(f"faults: [{{{fault}}}]\n" if fault else ""))


def of_part(part, kind, value=""):
    own = "" if part in ("brake-line", "controller") else ", wheelset: 2"
    return f"at: 0 s, part: {part}, kind: {kind}{own}{f', value: {value}' if value else ''}"


@pytest.mark.parametrize(("part", "kind"), [("hold-magnet", "shorted"), ("fill-valve", "stuck-closed")])
def test_a_tank_that_is_shut_off_stays_empty(stop, part, kind):
    _, after = stop(of_part(part, kind)).command(NOTHING, FILLED)
    assert after[1] < 0.05
    assert min(after[[0, 2, 3]]) > 0.5


@pytest.mark.parametrize(("part", "kind"), [("hold-magnet", "open-circuit"), ("fill-valve", "stuck-open")])
def test_a_tank_that_is_not_shut_off_goes_on_filling_and_air_blows_through_its_valve(stop, part, kind):
    """Vented, the tank keeps a pressure between those of the brake line and the atmosphere."""
    faulty = stop(of_part(part, kind))
    faulty.command(NOTHING, HALF_FULL)
    before, after = faulty.command(HOLD, 50)
    rises = after - before
    assert rises[1] > 3.0 * max(rises[[0, 2, 3]])
    faulty.command(NOTHING, 2 * FILLED)
    _, after = faulty.command(VENT, 200)
    assert 1.0 < after[1] < 5.0
    assert max(after[[0, 2, 3]]) < 0.1


@pytest.mark.parametrize(("part", "kind"), [("vent-magnet", "open-circuit"), ("vent-valve", "stuck-closed")])
def test_a_tank_that_cannot_be_vented_keeps_its_pressure(stop, part, kind):
    kept = stop(of_part(part, kind))
    kept.command(NOTHING, FILLED)
    before, after = kept.command(VENT, 100)
    assert after[1] == pytest.approx(before[1], rel=0.15)
    assert max(after[[0, 2, 3]]) < 0.5 * min(before)


@pytest.mark.parametrize(("part", "kind"), [("vent-magnet", "shorted"), ("vent-valve", "stuck-open")])
def test_a_tank_that_is_always_vented_gets_less(stop, part, kind):
    leaking = stop(of_part(part, kind))
    leaking.command(NOTHING, 2 * FILLED)
    before, after = leaking.command(HOLD, 100)
    assert before[1] < 0.95 * min(before[[0, 2, 3]])
    assert after[1] < 0.3 * before[1]


@pytest.mark.parametrize(
    ("part", "fault", "cycles", "share", "tolerance"),
    [("vent-valve", ("blocked", "60 %"), 8, 0.4, 0.08), ("wsp-valve", ("slow", "2 s"), 20, 0.15, 0.15)],
    ids=["blocked", "slow"],
)
def test_a_blocked_exhaust_vents_in_proportion_and_a_slow_valve_takes_its_time(
    stop, part, fault, cycles, share, tolerance
):
    """Choked, the flow is that of the open share: the pressure falls by about as much."""
    faulty = stop(of_part(part, *fault))
    faulty.command(NOTHING, 2 * FILLED)
    before, after = faulty.command(VENT, cycles)
    falls = before - after
    assert falls[1] > 0.0
    assert falls[1] / falls[2] == pytest.approx(share, abs=tolerance)


def test_a_brake_that_is_cut_out_has_no_force(stop):
    cut = stop(of_part("brake", "cut-out"))
    cut.command(NOTHING, 2 * FILLED)
    force = cut.rig.state.clamping_force
    assert force[1] == 0.0
    assert min(force[0], force[2], force[3]) > 5000.0


def test_a_leak_empties_a_tank_that_is_held(stop):
    leaking = stop(of_part("tank", "leak", "2e-8 m3/(s Pa)"))
    leaking.command(NOTHING, 2 * FILLED)
    before, after = leaking.command(HOLD, 200)
    assert after[1] < 0.5 * before[1]
    assert min((after / before)[[0, 2, 3]]) > 0.85


def test_the_relay_valve_replaces_what_leaks_from_the_brake_line(stop):
    """The tanks fill as without; the reservoir pays."""
    leaking, sound = stop(of_part("brake-line", "leak", "2e-8 m3/(s Pa)")), stop("")
    for each in (leaking, sound):
        each.command(NOTHING, 3 * FILLED)
    leaked, whole = leaking.rig.state, sound.rig.state
    np.testing.assert_allclose(leaked.tank_pressure, whole.tank_pressure, atol=0.1 * BAR)
    assert leaked.reservoir_pressure < whole.reservoir_pressure - 2000.0


def test_a_lost_sensor_says_so_and_a_stuck_one_shows_its_last_reading(stop):
    lost = stop("at: 0.2 s, until: 0.4 s, wheelset: 2, part: speed-sensor, kind: lost")
    lost.command(NOTHING, 60)
    assert [each.speed_valid[1] for each in lost.inputs] == [not 20 <= k < 40 for k in range(61)]
    assert {each.wheel_speed[1] for each in lost.inputs[20:40]} == {0.0}
    assert min(each.wheel_speed[1] for each in lost.inputs[:20] + lost.inputs[40:]) > 5.0
    assert all(each.speed_valid[0] for each in lost.inputs)
    stuck = stop("at: 1 s, wheelset: 2, part: speed-sensor, kind: stuck")
    stuck.command(NOTHING, 200)
    speeds = [each.wheel_speed[1] for each in stuck.inputs]
    assert set(speeds[100:]) == {speeds[99]}
    assert len(set(speeds[:100])) > 50
    assert all(each.speed_valid[1] for each in stuck.inputs)


@pytest.mark.parametrize(
    ("kind", "value", "expected"),
    [
        ("stuck", "18 km/h", lambda speed: 5.0),
        ("factor", "120 %", lambda speed: 1.2 * speed),
        ("offset", "-3.6 km/h", lambda speed: speed - 1.0),
        ("lost", "7.2 km/h", lambda speed: 2.0),
    ],
)
def test_a_wrong_sensor_shows_what_its_value_says(stop, kind, value, expected):
    """Beside wheelset 1, which turns as fast on a good rail until the brake acts."""
    wrong = stop(of_part("speed-sensor", kind, value))
    for each in wrong.inputs:
        assert each.wheel_speed[1] == pytest.approx(expected(each.wheel_speed[0]), rel=0.01)


def test_readings_jump_in_every_cycle_as_far_as_they_may_or_drop_out_by_their_share(stop):
    jumping = stop(of_part("speed-sensor", "jumps", "7.2 km/h"))
    jumping.command(NOTHING, 60)
    errors = [each.wheel_speed[1] - each.wheel_speed[0] for each in jumping.inputs]
    assert 1.5 < max(map(abs, errors)) < 2.1
    assert abs(np.mean(errors)) < 0.5
    assert len(set(errors)) == len(errors)
    failing = stop(of_part("speed-sensor", "drop-out", "25 %"))
    failing.command(VENT, 400)
    assert np.mean([each.wheel_speed[1] == 0.0 for each in failing.inputs]) == pytest.approx(0.25, abs=0.05)
    assert min(each.wheel_speed[0] for each in failing.inputs) > 5.0


def test_only_the_controller_sees_a_wrong_pressure(stop):
    """The rig computes forces from its own sensors."""
    wrong, sound = stop(of_part("pressure-sensor", "factor", "50 %")), stop("")
    for each in (wrong, sound):
        each.command(NOTHING, 2 * FILLED)
    seen, true = wrong.inputs[-1].cylinder_pressure, sound.inputs[-1].cylinder_pressure
    assert seen == (true[0], 0.5 * true[1], *true[2:])
    assert wrong.rig.state == sound.rig.state


def test_a_pressure_sensor_can_stick_or_be_off(stop):
    stuck = stop("at: 1 s, wheelset: 2, part: pressure-sensor, kind: stuck")
    stuck.command(NOTHING, 200)
    shown = [each.cylinder_pressure[1] for each in stuck.inputs]
    assert set(shown[100:]) == {shown[99]}
    off = stop(of_part("pressure-sensor", "offset", "-10 bar"))
    off.command(NOTHING, 200)
    assert {each.cylinder_pressure[1] for each in off.inputs[1:]} == {0.0}


def test_a_silent_controller_leaves_the_last_command_then_the_valves_fill_until_the_fault_ends(stop):
    silent = stop("at: 1 s, part: controller, kind: silent, value: 500 ms")
    silent.command(VENT, FILLED - 1)
    silent.command(HOLD, 1)
    _, kept = silent.command(VENT, 45)
    assert max(kept) < 0.1
    _, filled = silent.command(VENT, 60)
    assert min(filled) > 1.0
    silent = stop("at: 1 s, until: 1.5 s, part: controller, kind: silent")
    silent.command(NOTHING, 150)
    before, after = silent.command(VENT, 60)
    assert max(after) < 0.6 * min(before)
