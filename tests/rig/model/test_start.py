"""The rig at the instant of the brake command."""

import numpy as np
import pytest

from ..plain_numbers import step

NO_RESISTANCE = {"resistance_constant": 0.0, "resistance_linear": 0.0, "resistance_quadratic": 0.0}


def test_without_a_brake_the_train_rolls_on_as_it_began(rig, bench):
    """All parts are in equilibrium: nothing swings, nothing slides, no air flows."""
    quiet = {"commanded_pressure": 0.0, "loadcell_offset": 0.0, "loadcell_noise": 0.0, **NO_RESISTANCE}
    rolling = bench(rig.parameters(**quiet)[0])
    for wheelset in rolling.wheelsets:
        wheelset.friction = 0.3
    for _ in range(200):
        step(rolling.car, rolling.bogies, rolling.wheelsets, rolling.p)
    v = rolling.p.initial_speed
    for part in (rolling.car, *rolling.bogies, *rolling.wheelsets):
        assert part.speed == pytest.approx(v, rel=1e-12)
        assert part.position == pytest.approx(v * 0.1, rel=1e-12)
    for frame in (rolling.car, *rolling.bogies):
        np.testing.assert_allclose([frame.height, frame.pitch, frame.pitch_rate], 0.0, atol=1e-12)
    for wheelset in rolling.wheelsets:
        assert wheelset.wheel_radius * wheelset.rotation == pytest.approx(wheelset.speed, abs=1e-9)
        assert wheelset.wheel_load == pytest.approx(rolling.p.static_wheel_load)
    assert rolling.car.consumed_air == 0.0


def test_places_of_wheelsets_and_bogies(rig, bench):
    p = rig.parameters()[0]
    started = bench(p)
    ahead = [started.bogies[i // 2].ahead + started.wheelsets[i].ahead for i in range(4)]
    assert ahead == sorted(ahead, reverse=True)
    assert [ahead[0] - place for place in ahead] == pytest.approx([w.behind for w in started.wheelsets])
    assert ahead[0] - ahead[3] == pytest.approx(2.0 * (p.half_pivot_distance + p.half_wheelbase))


@pytest.mark.parametrize(
    ("topology", "calipers"), [("one-caliper", [1, 0, 0, 0]), ("four-caliper", [1, 1, 1, 1])]
)
def test_topology_says_which_modules_have_a_caliper(rig, bench, topology, calipers):
    started = bench(rig.parameters(f"rig.topology={topology}")[0])
    assert [wheelset.has_caliper for wheelset in started.wheelsets] == calipers


def test_tanks_hold_air_of_the_pressure_and_temperature_around_them(rig, bench):
    started = bench(rig.parameters("brake.system.air.temperature=-10 degC")[0])
    p = started.p
    assert [started.car.line_temperature, *(w.air_temperature for w in started.wheelsets)] == [263.15] * 5
    assert {started.car.line_coldness, *(w.air_coldness for w in started.wheelsets)} == {293.15 / 263.15}
    masses = [wheelset.air_mass for wheelset in started.wheelsets]
    volumes = [p.caliper_tank_volume, *3 * [p.tank_volume]]
    density = p.atmospheric_pressure / (p.gas_constant * p.air_temperature)
    assert masses == pytest.approx([density * volume for volume in volumes])
