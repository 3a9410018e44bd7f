"""The air of a module as it is computed, against vessels that obey the energy balance of physics.air."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.air import amount_gained, pressure_volume_after, travel_after

from .vessel import BARE, VOLUME, WALL, K, R, filled

PRESSURE_PER_MASS = R * WALL / VOLUME
WITH_BALLS = 12.0
"""Heat conductance of a tank with steel balls, W/K."""
SWEPT = 0.0265
CLOSING, OPENING = 1.43e5, 1.36e5


pressures = st.floats(1e5, 6e5)
exchanges = st.floats(0.0, 500.0)
rises = st.floats(-1e4, 1e4)


def flows(vessel, step):
    """Five seconds of filling from 5 bar, holding and venting to 1 bar, 0.1 s each, at random; in kg."""
    for valve in np.random.default_rng(4).choice([5e5, 1e5, None], 50):
        for _ in range(round(0.1 / step)):
            yield 0.0 if valve is None else 3e-8 * step * (valve - vessel.pressure)


def exchange_in(conductance, step):
    """Heat that the equations of the module exchange in a step, W in their notation."""
    return (K - 1.0) * conductance * step * WALL / VOLUME


def error_of_the_amount(conductance, step):
    """Largest error of the air that a tank's pressure tells, over the air that flowed."""
    tank, exchange = filled(1e5), exchange_in(conductance, step)
    amount, errors = tank.mass * PRESSURE_PER_MASS, []
    for mass in flows(tank, step):
        before = tank.pressure
        tank.step(mass, exchange=conductance * step)
        amount += amount_gained(before, tank.pressure - before, amount, exchange, K)
        errors.append(abs(amount - tank.mass * PRESSURE_PER_MASS))
    return max(errors) / (tank.mass * PRESSURE_PER_MASS)


def error_of_the_pressure(conductance, step):
    """Largest error of the pressure of a module whose flows are known and whose volume goes to and fro."""
    module, exchange = filled(1e5, volume=(1.0 - SWEPT) * VOLUME), exchange_in(conductance, step)
    pressure, amount, errors = module.pressure, module.mass * PRESSURE_PER_MASS, []
    for n, mass in enumerate(flows(module, step)):
        growth = SWEPT * step * math.cos(n * step)
        volume, gained = module.volume / VOLUME, mass * PRESSURE_PER_MASS
        module.step(mass, growth=growth * VOLUME, exchange=conductance * step)
        after = pressure_volume_after(pressure, volume, growth, amount, gained, exchange, K)
        pressure, amount = after / (module.volume / VOLUME), amount + gained
        errors.append(abs(pressure / module.pressure - 1.0))
    return max(errors)


@pytest.mark.parametrize("error", [error_of_the_amount, error_of_the_pressure])
def test_without_heat_the_air_is_that_of_the_tanks_energy_balance(error):
    assert error(0.0, 5e-4) < 1e-11


@pytest.mark.parametrize("error", [error_of_the_amount, error_of_the_pressure])
@pytest.mark.parametrize("conductance", [BARE, WITH_BALLS])
def test_with_heat_the_air_is_that_of_the_tanks_energy_balance(error, conductance):
    """But for the heat of a step, which is that of its beginning here and that of its end there."""
    coarse = error(conductance, 5e-4)
    assert 0.0 < coarse < 1e-3
    assert error(conductance, 2.5e-4) == pytest.approx(0.5 * coarse, rel=0.05)


@given(pressures, pressures, rises, exchanges)
def test_a_module_like_the_tank_has_the_tanks_pressure(pressure, amount, rise, exchange):
    """What the tank's pressure tells of its air gives, put into the same volume, that pressure again."""
    gained = amount_gained(pressure, rise, amount, exchange, K)
    after = pressure_volume_after(pressure, 1.0, 0.0, amount, gained, exchange, K)
    assert after == pytest.approx(pressure + rise, rel=1e-14)


@given(pressures, st.floats(0.9, 1.0), exchanges)
def test_air_at_rest_does_not_change_by_a_bit(pressure, volume, exchange):
    assert amount_gained(pressure, 0.0, pressure, exchange, K) == 0.0
    amount = pressure * volume
    assert pressure_volume_after(pressure, volume, 0.0, amount, 0.0, exchange, K) == amount


@given(pressures, st.floats(0.7, 1.3), st.floats(1.0, 500.0))
def test_an_amount_that_was_wrong_comes_right_while_the_pressure_rests(pressure, share, exchange):
    """Air of the wall's temperature has q = p: what sensors and starts falsify does not last."""
    amount = share * pressure
    gained = amount_gained(pressure, 0.0, amount, exchange, K)
    assert abs(amount + gained - pressure) <= abs(amount - pressure)
    assert gained * (pressure - amount) >= 0.0


def volume_at(travel):
    return 1.0 + SWEPT * (travel - 1.0)


@given(st.floats(0.0, 1.0), st.floats(0.5e5, 6e5))
def test_the_piston_keeps_its_pressure_between_the_two_while_it_has_somewhere_to_go(travel, pressure):
    pressure_volume = pressure * volume_at(travel)
    after = travel_after(travel, pressure_volume, SWEPT, CLOSING, OPENING)
    left = pressure_volume / volume_at(after)
    assert 0.0 <= after <= 1.0
    if after < 1.0:
        assert left <= CLOSING * (1.0 + 1e-12)
    if after > 0.0:
        assert left >= OPENING * (1.0 - 1e-12)


@given(st.floats(0.0, 1.0), st.floats(OPENING, CLOSING))
def test_between_the_two_pressures_the_piston_stays(travel, pressure):
    after = travel_after(travel, pressure * volume_at(travel), SWEPT, CLOSING, OPENING)
    assert after == pytest.approx(travel, abs=1e-13)


def test_the_piston_moves_out_at_the_closing_pressure_and_back_at_the_opening_pressure():
    """Air is let in and out isothermally, grain by grain: where the travel begins and ends is a pressure."""
    amounts = np.linspace(1.2e5, 1.6e5, 4001)
    travel, rows = 0.0, []
    for amount in [*amounts.tolist(), *amounts[::-1].tolist()]:
        travel = travel_after(travel, amount, SWEPT, CLOSING, OPENING)
        rows.append((travel, amount / volume_at(travel)))
    travels, reached = np.array(rows[: amounts.size]).T, np.array(rows[amounts.size :]).T
    for (path, pressure), held in ((travels, CLOSING), (reached, OPENING)):
        under_way = (path > 0.0) & (path < 1.0)
        assert under_way.sum() > 100
        np.testing.assert_allclose(pressure[under_way], held, rtol=1e-12)
        assert {path[0], path[-1]} == {0.0, 1.0}
