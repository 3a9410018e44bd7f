"""A stop that slides at one energy per metre: its rail is equally clean everywhere, as if found so."""

import numpy as np

from uictest.core.units import STANDARD_GRAVITY
from uictest.recorded.field_data import stated_case
from uictest.recorded.fitting.balances import Balances, wheelset_creep, windows_of
from uictest.recorded.fitting.cleaning import find_cleaning
from uictest.recorded.fitting.samples import StopSamples
from uictest.recorded.fitting.stretches import CleanedStop, RailUnderStop, Stretches

ENERGY, FRICTION, CLEAN = 8000.0, 0.07, 0.22
LOSS = 2000.0
"""J/m"""


def steady_slide(scenario):
    """Samples of a stop whose four wheelsets lose as much per metre as long as it lasts."""
    friction = FRICTION - np.expm1(-LOSS / ENERGY) * (CLEAN - FRICTION)
    vehicle, rail = scenario.vehicle, scenario.rail.condition
    # Slip and force depend on the speed alone.
    grid = np.linspace(9.0, 30.0, 2000)
    load = np.full_like(grid, vehicle.total_mass * STANDARD_GRAVITY / 8.0)
    slip = np.full_like(grid, 6.0)
    for _ in range(100):
        force = wheelset_creep(slip, grid, load, np.full_like(grid, friction), rail)
        slip = 0.5 * (slip + LOSS * grid / force)
    np.testing.assert_allclose(slip * force, LOSS * grid, rtol=1e-9)
    speeds, step = [30.0], 0.01
    while speeds[-1] > 10.0:
        speeds.append(speeds[-1] - step * 4.0 * np.interp(speeds[-1], grid, force) / vehicle.total_mass)
    speed = np.array(speeds[:-1])
    return samples(scenario, speed, np.interp(speed, grid, slip), np.interp(speed, grid, force), step)


def samples(scenario, speed, slip, force, step):
    four, n = np.ones((4, 1)), len(speed)
    dice = np.random.default_rng(1)
    wheelset, time = scenario.vehicle.wheelset, step * np.arange(n)
    wheels = four * (speed - slip)
    turning = wheelset.rotational_inertia / wheelset.radius * np.gradient(wheels, time, axis=1)
    torque = wheelset.radius * four * force - turning
    place = np.cumsum(speed) * step - np.array([[0.0], [2.5], [17.5], [20.0]])
    load = scenario.vehicle.total_mass * STANDARD_GRAVITY / 8.0 * np.ones((4, n))
    sliding = np.ones((4, 1), bool) & (time > 1.0)
    noisy = torque * (1.0 + 0.01 * dice.normal(size=torque.shape))
    return StopSamples(
        time, speed, wheels, speed - wheels, place, load, noisy, sliding, np.zeros((4, n), bool)
    )


def test_one_level_of_energy_does_not_tell_both_numbers():
    cleaning = f"{{energy: {ENERGY} J/m, recovered_friction: {CLEAN}, reach: 0.5 m, carry_over: 0}}"
    settings = ["rail.condition=wet", f"rail.friction={FRICTION}", f"rail.cleaning={cleaning}"]
    scenario = stated_case("one", 30.0, settings).scenario
    recorded = steady_slide(scenario)
    stop = CleanedStop(RailUnderStop(Stretches(Balances(recorded, windows_of(recorded), scenario), ())))
    estimate = find_cleaning([stop], ENERGY, CLEAN).cleaning
    assert estimate.standing == "not seen"
    assert estimate.energy < ENERGY
