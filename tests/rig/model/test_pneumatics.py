"""Air of the rig: what flows in, what is stored, what flows out."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from uictest.rig.model.balance import stored_air
from uictest.rig.model.pneumatics import step_supply, step_tank

Benches = Callable[[Any], Any]


def set_valves(bench: Any, fill: float, vent: float) -> None:
    for wheelset in bench.wheelsets:
        wheelset.fill_before = wheelset.fill_after = wheelset.fill_opening = fill
        wheelset.vent_before = wheelset.vent_after = wheelset.vent_opening = vent


def blow(bench: Any, steps: int) -> None:
    for _ in range(steps):
        drawn = sum(step_tank(wheelset, bench.car, bench.p) for wheelset in bench.wheelsets)
        step_supply(bench.car, drawn, bench.p)
        bench.car.steps += 1.0
        bench.car.time = bench.car.steps * bench.p.step


@pytest.fixture(name="braked")
def _braked(rig: Any, bench: Benches) -> Any:
    """A rig after eight seconds of braking, its valves filling."""
    braked = bench(rig.parameters()[0])
    set_valves(braked, fill=1.0, vent=0.0)
    blow(braked, 16_000)
    return braked


def test_brake_line_and_tanks_reach_the_demand(braked: Any) -> None:
    p = braked.p
    assert braked.car.demanded_pressure == p.commanded_pressure
    assert braked.car.line_pressure - p.atmospheric_pressure == pytest.approx(p.commanded_pressure, rel=1e-4)
    for wheelset in braked.wheelsets:
        assert wheelset.pressure == pytest.approx(braked.car.line_pressure, rel=1e-5)


def test_air_that_left_the_reservoir_is_in_the_line_and_the_tanks(braked: Any) -> None:
    car = braked.car
    lost = braked.p.reservoir_pressure - car.reservoir_pressure
    expected = (car.consumed_air - car.compressor_air) * braked.p.gas_constant * braked.p.air_temperature
    assert lost * braked.p.reservoir_volume == pytest.approx(expected, rel=1e-9)
    assert stored_air(car, braked.wheelsets) == pytest.approx(car.initial_air + car.compressor_air, rel=1e-13)


def test_nothing_is_lost_however_the_valves_move(rig: Any, bench: Benches) -> None:
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


def test_held_tanks_keep_their_pressure_and_vented_ones_fall_to_the_atmosphere(braked: Any) -> None:
    held = braked.wheelsets[1].pressure
    set_valves(braked, fill=0.0, vent=0.0)
    blow(braked, 2000)
    assert braked.wheelsets[1].pressure == held
    set_valves(braked, fill=0.0, vent=1.0)
    blow(braked, 20_000)
    assert braked.wheelsets[1].pressure == pytest.approx(braked.p.atmospheric_pressure, rel=1e-3)


def test_overcharged_line_is_exhausted_by_the_relay_valve(braked: Any) -> None:
    braked.p.commanded_pressure *= 0.5
    blow(braked, 8000)
    assert braked.car.exhausted_air > 0.0
    gauge = braked.car.line_pressure - braked.p.atmospheric_pressure
    assert gauge == pytest.approx(braked.p.commanded_pressure, rel=0.02)


def test_moving_piston_draws_on_the_air_of_its_tank_and_of_no_other(braked: Any) -> None:
    """p V^n stays: 0.1 mm of stroke in a closed tank."""
    set_valves(braked, fill=0.0, vent=0.0)
    before = [wheelset.pressure for wheelset in braked.wheelsets]
    for wheelset in braked.wheelsets:
        wheelset.stroke = wheelset.stroke_change = 1e-4
    blow(braked, 1)
    after = [wheelset.pressure for wheelset in braked.wheelsets]
    p = braked.p
    growth = p.piston_area * 1e-4 / p.caliper_tank_volume
    assert after[0] == pytest.approx(before[0] * (1.0 - p.polytropic_exponent * growth), rel=1e-5)
    assert after[1:] == before[1:]


def test_position_g_fills_more_slowly_than_r(rig: Any) -> None:
    def developed(position: str) -> float:
        trace = rig.columns(f"brake.position={position}")
        full = trace["tank_pressure"].max(axis=0)
        return float(trace["time"][np.argmax(trace["tank_pressure"][:, 1] > 0.95 * full[1])])

    assert developed("R") < 3.0
    assert 18.0 < developed("G") < 30.0


def test_compressor_refills_the_reservoir_up_to_its_cut_out(rig: Any, bench: Benches) -> None:
    p = rig.parameters(compressor_delivery=0.5)[0]
    p.reservoir_pressure = p.compressor_cut_in - 1e4
    low = bench(p)
    blow(low, 4000)
    assert low.car.compressor_running == 0.0
    assert low.car.compressor_air > 0.0
    assert low.car.reservoir_pressure == pytest.approx(p.compressor_cut_out, rel=5e-2)
