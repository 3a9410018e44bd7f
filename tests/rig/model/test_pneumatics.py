"""Air of the rig: what flows in, what is stored, what flows out."""

from copy import deepcopy

import numpy as np
import pytest

from uictest.core.physics.air import REFERENCE_TEMPERATURE
from uictest.rig.model.balance import air_energy_residual, stored_air
from uictest.rig.model.pneumatics import step_air


def set_valves(bench, fill, vent):
    for wheelset in bench.wheelsets:
        wheelset.fill_before = wheelset.fill_after = wheelset.fill_opening = fill
        wheelset.vent_before = wheelset.vent_after = wheelset.vent_opening = vent


def blow(bench, steps):
    for _ in range(steps):
        step_air(bench.car, bench.wheelsets, bench.p)
        bench.car.steps += 1.0
        bench.car.time = bench.car.steps * bench.p.step


@pytest.fixture(scope="module")
def histories(rig, bench):
    """A rig after eight seconds of braking, and one whose valves were shut for the first three."""
    p = rig.parameters()[0]
    starts = {"braked": bench(p), "charged": bench(p)}
    for start, fill, steps in zip(starts.values(), (1.0, 0.0), (16_000, 6000), strict=True):
        set_valves(start, fill, vent=0.0)
        blow(start, steps)
    return starts


@pytest.fixture
def braked(histories):
    """A rig after eight seconds of braking, its valves filling."""
    return deepcopy(histories["braked"])


@pytest.fixture
def charged(histories):
    """A rig with a full brake line before empty tanks."""
    return deepcopy(histories["charged"])


def test_line_and_tanks_reach_the_demand_with_the_air_that_left_the_reservoir(braked):
    p = braked.p
    assert braked.car.demanded_pressure == p.commanded_pressure
    assert braked.car.line_pressure - p.atmospheric_pressure == pytest.approx(p.commanded_pressure, rel=1e-4)
    for wheelset in braked.wheelsets:
        # Air still flows in while what is there gives off its heat.
        assert wheelset.pressure == pytest.approx(braked.car.line_pressure, rel=3e-4)
    car = braked.car
    lost = braked.p.reservoir_pressure - car.reservoir_pressure
    expected = (car.consumed_air - car.compressor_air) * braked.p.gas_constant * braked.p.air_temperature
    assert lost * braked.p.reservoir_volume == pytest.approx(expected, rel=1e-9)
    assert stored_air(car, braked.wheelsets) == pytest.approx(car.initial_air + car.compressor_air, rel=1e-13)


def test_nothing_is_lost_however_the_valves_move(rig, bench):
    moving = bench(rig.parameters()[0])
    random = np.random.default_rng(6)
    for _ in range(200):
        set_valves(moving, *random.integers(0, 2, 2).astype(float).tolist())
        blow(moving, 20)
    car = moving.car
    vented = sum(wheelset.vented_air for wheelset in moving.wheelsets)
    assert vented > 0.0
    left = car.initial_air + car.compressor_air - car.exhausted_air - vented
    assert stored_air(car, moving.wheelsets) == pytest.approx(left, rel=1e-13)
    assert abs(air_energy_residual(car, moving.wheelsets, moving.p)) < 1e-12


@pytest.mark.parametrize(
    ("start", "fill", "vent"), [("charged", 1.0, 0.0), ("braked", 0.0, 1.0)], ids=["filled", "vented"]
)
def test_held_tanks_come_to_the_temperature_of_their_walls(histories, start, fill, vent):
    """T - Tw falls as exp(-t h A / (m cv)); the pressure sinks after a quick fill, rises after a vent."""
    held = deepcopy(histories[start])
    set_valves(held, fill, vent)
    blow(held, 400)
    set_valves(held, fill=0.0, vent=0.0)
    p, modules = held.p, held.wheelsets[:2]
    excess = np.array([module.air_temperature - p.air_temperature for module in modules])
    pressures = [[module.pressure for module in modules]]
    for _ in range(10):
        blow(held, 200)
        pressures.append([module.pressure for module in modules])
    warm = fill - vent
    assert np.all(warm * excess > 5.0)
    assert np.all(warm * np.diff(pressures, axis=0) < 0.0)
    masses = np.array([module.air_mass for module in modules])
    conductances = np.array([p.caliper_tank_exchange, p.tank_exchange]) / p.step
    temperatures = p.air_temperature + excess * np.exp(-conductances / (masses * p.heat_capacity_volume))
    np.testing.assert_allclose([m.air_temperature for m in modules], temperatures, rtol=1e-3)
    gas_law = masses * p.gas_constant * temperatures / [p.caliper_tank_volume, p.tank_volume]
    np.testing.assert_allclose(pressures[-1], gas_law, rtol=1e-3)


def test_vented_tanks_fall_to_the_atmosphere(braked):
    set_valves(braked, fill=0.0, vent=1.0)
    blow(braked, 10_000)
    assert braked.wheelsets[1].pressure == pytest.approx(braked.p.atmospheric_pressure, rel=1e-3)


def test_temperatures_stay_those_of_brakes_however_the_valves_move(charged):
    """From a full line into empty tanks and out again: hotter or colder than this, no step was right."""
    random = np.random.default_rng(2)
    for fill, vent in [(1.0, 0.0), *random.choice([(1.0, 0.0), (0.0, 0.0), (0.0, 1.0)], 80)]:
        set_valves(charged, fill, vent)
        for _ in range(8):
            blow(charged, 25)
            air = [wheelset.air_temperature for wheelset in charged.wheelsets]
            assert all(150.0 < temperature < 450.0 for temperature in (charged.car.line_temperature, *air))


def test_flows_are_those_of_air_of_the_temperature_that_it_came_to(charged):
    set_valves(charged, fill=1.0, vent=0.0)
    blow(charged, 200)
    car, modules = charged.car, charged.wheelsets
    temperatures = [car.line_temperature, *(wheelset.air_temperature for wheelset in modules)]
    assert min(abs(temperature - charged.p.air_temperature) for temperature in temperatures) > 0.5
    coldness = [car.line_coldness, *(wheelset.air_coldness for wheelset in modules)]
    assert coldness == [REFERENCE_TEMPERATURE / temperature for temperature in temperatures]
    # The balls keep the air nearer to the temperature of the wall.
    blow(charged, 200)
    with_balls, *bare = (w.air_temperature - charged.p.air_temperature for w in modules)
    assert 0.0 < with_balls < 0.9 * min(bare)


def test_a_tank_takes_the_enthalpy_of_the_air_in_the_line(charged):
    """Of a line that is warmer than its wall: cp T_line m_in, less what the wall takes in a step."""
    p, car, tank = charged.p, charged.car, charged.wheelsets[1]
    car.line_temperature = 350.0
    set_valves(charged, fill=1.0, vent=0.0)
    mass, energy = tank.air_mass, tank.air_mass * tank.air_temperature * p.heat_capacity_volume
    heat = tank.wall_heat
    blow(charged, 1)
    gained = tank.air_mass * tank.air_temperature * p.heat_capacity_volume - energy - (tank.wall_heat - heat)
    assert tank.air_mass > mass
    assert gained == pytest.approx(p.heat_capacity_pressure * 350.0 * (tank.air_mass - mass), rel=1e-9)


def test_air_at_rest_does_not_change_by_a_bit(rig, bench):
    """Until the dead time of the command is over."""
    resting = bench(rig.parameters()[0])
    before = [(w.pressure, w.air_temperature, w.air_mass) for w in resting.wheelsets]
    line = resting.car.line_pressure, resting.car.line_temperature
    blow(resting, int(resting.p.dead_time / resting.p.step))
    assert [(w.pressure, w.air_temperature, w.air_mass) for w in resting.wheelsets] == before
    assert (resting.car.line_pressure, resting.car.line_temperature) == line


def test_overcharged_line_is_exhausted_by_the_relay_valve(braked):
    braked.p.commanded_pressure *= 0.5
    braked.car.demand_change *= 0.5
    blow(braked, 8000)
    assert braked.car.exhausted_air > 0.0
    gauge = braked.car.line_pressure - braked.p.atmospheric_pressure
    assert gauge == pytest.approx(braked.p.commanded_pressure, rel=0.02)
    assert abs(air_energy_residual(braked.car, braked.wheelsets, braked.p)) < 1e-12


def test_moving_piston_draws_on_the_air_of_its_tank_and_of_no_other(rig, bench):
    """p V^1.4 stays: 0.1 mm of stroke in a closed tank, too quick for heat; p dV is its work."""
    closed = bench(rig.parameters()[0])
    set_valves(closed, fill=0.0, vent=0.0)
    before = [wheelset.pressure for wheelset in closed.wheelsets]
    for wheelset in closed.wheelsets:
        wheelset.stroke = wheelset.stroke_change = 1e-4
    blow(closed, 1)
    after = [wheelset.pressure for wheelset in closed.wheelsets]
    p = closed.p
    growth = p.piston_area * 1e-4 / p.caliper_tank_volume
    assert after[0] == pytest.approx(before[0] * (1.0 + growth) ** -p.heat_capacity_ratio, rel=1e-5)
    assert after[1:] == before[1:]
    work = [wheelset.piston_work for wheelset in closed.wheelsets]
    assert work == pytest.approx([before[0] * p.piston_area * 1e-4, 0.0, 0.0, 0.0])


def test_work_on_the_piston_is_in_the_account_of_the_airs_energy(braked):
    for stroke in np.linspace(0.0, 3e-3, 50).tolist():
        caliper = braked.wheelsets[0]
        caliper.stroke_change, caliper.stroke = stroke - caliper.stroke, stroke
        blow(braked, 1)
    assert braked.wheelsets[0].piston_work > 10.0
    assert abs(air_energy_residual(braked.car, braked.wheelsets, braked.p)) < 1e-12


def test_position_g_fills_more_slowly_than_r(rig):
    def developed(position):
        trace = rig.columns(f"brake.position={position}")
        full = trace["tank_pressure"].max(axis=0)
        return float(trace["time"][np.argmax(trace["tank_pressure"][:, 1] > 0.95 * full[1])])

    assert developed("R") < 3.0
    assert 18.0 < developed("G") < 30.0


def test_compressor_refills_the_reservoir_up_to_its_cut_out(rig, bench):
    p = rig.parameters(compressor_delivery=0.5)[0]
    p.reservoir_pressure = p.compressor_cut_in - 1e4
    low = bench(p)
    blow(low, 4000)
    assert low.car.compressor_running == 0.0
    assert low.car.compressor_air > 0.0
    assert low.car.reservoir_pressure == pytest.approx(p.compressor_cut_out, rel=5e-2)
