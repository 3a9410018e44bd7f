"""The load of the car, and the valve that lets the brake pressure follow it."""

import numpy as np
import pytest

FOUR = "rig.topology=four-caliper"
PAYLOAD = "vehicle.payload=8 t"
VALVE = "brake.system.load_valve={empty_share: 80 %}"


def bits(stop):
    return bytes(stop.measures.tobytes() + stop.wheelset_measures.tobytes())


def highest_demand(rig, *overrides):
    return float(rig.columns(*overrides)["demanded_pressure"].max())


def test_a_loaded_car_is_a_car_with_the_heavier_body_of_the_same_radius_of_gyration(rig):
    body = rig.case().scenario.vehicle.body
    mass = body.mass + 8000.0
    inertia = body.pitch_inertia * (mass / body.mass)
    heavier = (f"vehicle.body.mass={mass!r} kg", f"vehicle.body.pitch_inertia={inertia!r} kg m2")
    loaded = rig.stop(PAYLOAD, "vehicle.load=full", FOUR)
    assert bits(loaded) == bits(rig.stop(*heavier, FOUR))
    assert bits(rig.stop(PAYLOAD, "vehicle.load=8000 kg", FOUR)) == bits(loaded)


def test_an_empty_car_is_the_car_without_a_payload(rig):
    alone = bits(rig.stop(FOUR))
    for load in ("empty", "0 t"):
        assert bits(rig.stop(PAYLOAD, f"vehicle.load={load}", FOUR)) == alone


@pytest.mark.parametrize(("load", "share"), [("empty", 0.8), ("2 t", 0.85), ("full", 1.0)])
def test_the_pressure_is_linear_in_the_load(rig, load, share):
    full = rig.case().scenario.brake.system.positions["R"].maximum_pressure
    demand = highest_demand(rig, PAYLOAD, VALVE, f"vehicle.load={load}", "brake.command=50 %", FOUR)
    assert demand == pytest.approx(0.5 * share * full, rel=1e-9)


def test_a_valve_that_follows_the_mass_keeps_the_stopping_distance(rig):
    """Force follows the pressure beyond that of touching pads; its share is that of the masses."""
    scenario = rig.case().scenario
    caliper, mass = scenario.rig.caliper, scenario.vehicle.total_mass
    touching = caliper.preload + caliper.spring_rate * caliper.clearance + caliper.coulomb_friction
    lost = touching / caliper.piston_area / scenario.brake.system.positions["R"].maximum_pressure
    share = lost + (1.0 - lost) * mass / (mass + 8000.0)
    valve = f"brake.system.load_valve={{empty_share: {100.0 * share:.6f} %}}"
    empty, full = (
        rig.stop(PAYLOAD, valve, f"vehicle.load={load}", FOUR).measures.braking_distance
        for load in ("empty", "full")
    )
    assert full == pytest.approx(empty, rel=0.01)
    without = rig.stop(PAYLOAD, "vehicle.load=full", FOUR).measures.braking_distance
    assert without > 1.1 * rig.stop(FOUR).measures.braking_distance


def test_controllers_see_the_share_of_the_command_whatever_the_load(rig):
    for load in ("empty", "full"):
        p, _ = rig.parameters(PAYLOAD, VALVE, f"vehicle.load={load}", "brake.command=60 %", FOUR)
        assert p["commanded_pressure"] * p["demand_per_pressure"] == pytest.approx(0.6)


def test_wheel_loads_carry_the_load_and_everything_balances(rig):
    stop = rig.stop(PAYLOAD, VALVE, "vehicle.load=full", FOUR, "rail.condition=wet", "rail.friction=0.1")
    assert abs(stop.measures.energy_residual) < 1e-9
    loads = rig.columns(PAYLOAD, "vehicle.load=full", FOUR)["wheel_load"]
    mass = rig.case().scenario.vehicle.total_mass + 8000.0
    assert np.median(loads.sum(axis=1)) == pytest.approx(mass * 9.80665 / 2.0, rel=1e-3)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (["vehicle.load=full"], "this car has no payload"),
        ([PAYLOAD, "vehicle.load=9 t"], "more than the payload of 8 t"),
        ([PAYLOAD, "vehicle.load=laden"], "expected one of empty, full"),
        ([VALVE], "no payload that the pressure could follow"),
        ([PAYLOAD, "brake.system.load_valve={empty_share: 5 %}"], "5 %"),
    ],
)
def test_what_cannot_be_is_refused(rig, settings, message):
    with pytest.raises(Exception, match=message):
        rig.case(*settings)
