"""Whole stops from their start: against closed forms, and what they must conserve."""

import numpy as np
import pytest

from ..plain_numbers import step

NO_RESISTANCE = {"resistance_constant": 0.0, "resistance_linear": 0.0, "resistance_quadratic": 0.0}
EXACT_SENSORS = {"pressure_noise": 0.0, "loadcell_noise": 0.0, "pressure_offset": 0.0, "loadcell_offset": 0.0}
DRY = "initial_speed=120 km/h"


def masses(p):
    """Mass of the car, and the mass that its kinetic energy seems to have, kg."""
    mass = p.body_mass + 2.0 * p.bogie_mass + 4.0 * p.wheelset_mass
    return mass, mass + 4.0 * p.rotational_inertia / p.wheel_radius**2


def brake_force(p, trace):
    """Force of all brakes at the wheel rims, from the recorded clamping forces, N."""
    faces = p.calipers_per_wheelset * p.pads_per_caliper
    return (
        faces
        * p.reference_pad_friction
        * p.disc_radius
        / p.wheel_radius
        * trace["clamping_force"].sum(axis=1)
    )


@pytest.mark.parametrize("gradient", [0, 20, -20])
@pytest.mark.parametrize("position", ["R", "G"])
def test_dry_stop_is_that_of_the_textbook(rig, gradient, position):
    """s = v0 te + v0^2 / (2 a), with the equivalent build-up time te from the history of the force.

    The gradient acts from the start: it changes the deceleration and, during te, the speed.
    """
    settings = NO_RESISTANCE | EXACT_SENSORS
    overrides = (DRY, f"brake.position={position}", f"rail.gradient={gradient} permille")
    p = rig.parameters(*overrides, **settings)[0]
    trace = rig.columns(*overrides, every=2, **settings)
    mass, inert = masses(p)
    force = brake_force(p, trace)
    full = force[-1]
    te = np.trapezoid(1.0 - force / full, trace["time"])
    downhill = -p.gravity * gradient / 1000.0 * mass / inert
    a = full / inert - downhill
    v0 = p.initial_speed
    v_te = v0 + downhill * te
    expected = v0 * te + downhill * te**2 / 2.0 + v_te**2 / (2.0 * a)
    # Only the area of the build-up counts in te; its spread changes the distance in second order.
    late = np.trapezoid(trace["time"] * (1.0 - force / full), trace["time"])
    expected -= full / inert * (late - te**2 / 2.0)
    measures = rig.stop(*overrides, every=2, **settings).measures
    assert measures.braking_distance == pytest.approx(expected, rel=2e-3)
    assert measures.braking_time == pytest.approx(te + v_te / a, rel=2e-3)


def test_standstill_lies_between_two_steps_where_the_speed_says(rig):
    trace = rig.columns(DRY, every=1)
    measures = rig.stop(DRY, every=1).measures
    after = int(np.argmax(trace["speed"] <= 0.0))
    moving = trace["speed"][after - 1], trace["speed"][after]
    zero = trace["time"][after - 1] + 5e-4 * moving[0] / (moving[0] - moving[1])
    assert measures.braking_time == pytest.approx(zero, abs=1e-9)
    assert measures.braking_distance == pytest.approx(trace["distance"][after], abs=1e-4)
    assert measures.end_speed == 0.0


def test_a_train_without_a_brake_rolls_against_its_resistance_and_downhill_as_closed_forms_say(rig):
    """M v' = -(a + b v + c v^2) has a closed form: v falls along a tangent."""
    settings = {"commanded_pressure": 0.0, "cycles": 6000, **EXACT_SENSORS}
    p = rig.parameters(DRY, **settings)[0]
    trace = rig.columns(DRY, **settings)
    inert = masses(p)[1]
    a, b, c = p.resistance_constant, p.resistance_linear, p.resistance_quadratic
    root = np.sqrt(4.0 * a * c - b * b)
    phase = np.arctan((2.0 * c * p.initial_speed + b) / root) - root * trace["time"] / (2.0 * inert)
    expected = (root * np.tan(phase) - b) / (2.0 * c)
    assert expected[-1] < 0.95 * p.initial_speed
    np.testing.assert_allclose(trace["speed"], expected, rtol=2e-5)
    settings = {"commanded_pressure": 0.0, "cycles": 1000, **NO_RESISTANCE, **EXACT_SENSORS}
    overrides = (DRY, "rail.gradient=-25 permille")
    p = rig.parameters(*overrides, **settings)[0]
    trace = rig.columns(*overrides, **settings)
    mass, inert = masses(p)
    gained = trace["speed"][-1] - p.initial_speed
    assert gained == pytest.approx(p.gravity * 0.025 * mass / inert * trace["time"][-1], rel=2e-3)


STEADY = {
    "dry": (DRY,),
    "dry in position G": (DRY, "brake.position=G"),
    "uphill": (DRY, "rail.gradient=20 permille"),
    "locked": ("rail.condition=wet", "rail.friction=0.06", "rig.wsp=bypassed"),
}


@pytest.mark.parametrize("kind", STEADY)
def test_halving_the_step_changes_distance_and_time_by_less_than_a_per_mille(rig, kind):
    coarse = rig.stop(*STEADY[kind]).measures
    fine = rig.stop(*STEADY[kind], "simulation.time_step=0.25 ms").measures
    assert fine.braking_distance == pytest.approx(coarse.braking_distance, rel=1e-3)
    assert fine.braking_time == pytest.approx(coarse.braking_time, rel=1e-3)


@pytest.mark.parametrize("friction", [0.005, 0.03, 0.1, 0.3])
def test_standstill_is_reached_on_every_rail(rig, friction):
    overrides = ("rail.condition=wet", f"rail.friction={friction}", "initial_speed=10 km/h")
    assert rig.stop(*overrides).measures.stopped == 1.0


def test_a_train_that_is_not_stopped_in_time_has_not_stopped(rig):
    measures = rig.stop(DRY, cycles=500).measures
    assert (measures.stopped, measures.end_time) == (0.0, 5.0)
    assert np.isnan(measures.braking_distance)


CLIMBING = ("rail.condition=wet", "rail.gradient=10 permille")
SLIPPERY = ("rail.condition=wet", "rail.friction=0.08")
FAST = (*SLIPPERY, DRY)
CLEANING = "rail.cleaning={energy: 5300 J/m, recovered_friction: 0.28, reach: 0.5 m, carry_over: 0.5}"
CURVES = ("rail.condition=wet-curves", "rail.friction=0.08")
LAYER = ("rail.condition=leaf-layer",)
BYPASSED = "rig.wsp=bypassed"
MOTORS = "brake.dynamic={force: 60 kN, power: 1.6 MW}"
AGAIN = "brake.command=[{at: 0 s, value: 100 %}, {at: 5 s, value: 0 %}, {at: 9 s, value: 80 %}]"
VARIED = "rail.variation={spread: 40 %, correlation_length: 10 m, left_right_correlation: 0.5}"
RADII = [f"vehicle.wheelsets.{number}.wheel_radius={0.40 + 0.01 * number} m" for number in (1, 2, 3, 4)]
RADII.append("rig.compensation=full")
BALANCED = {
    "very slippery": (*CLIMBING, "rail.friction=0.04"),
    "slippery": (*CLIMBING, "rail.friction=0.12"),
    "wet": (*CLIMBING, "rail.friction=0.3"),
    "pads that fade": (DRY, "brake.pad=disc-pad", "rail.condition=wet", "rail.friction=0.09"),
    "random rail": (*FAST, VARIED),
    "slides": FAST,
    "slides, cleaned": (*FAST, CLEANING),
    "locks": (*FAST, BYPASSED),
    "locks, cleaned": (*FAST, BYPASSED, CLEANING),
    "curves": CURVES,
    "curves, locks": (*CURVES, BYPASSED),
    "layer": LAYER,
    "layer, locks": (*LAYER, BYPASSED),
    "motors": (MOTORS,),
    "motors, bypassed": (MOTORS, BYPASSED),
    "motors, slides": (*SLIPPERY, MOTORS),
    "motors, locks": (*SLIPPERY, MOTORS, BYPASSED),
    "applied again": (AGAIN,),
    "applied again, slides": (AGAIN, "rail.condition=wet", "rail.friction=0.10"),
    "radii": RADII,
    "radii, slides": (*RADII, "rail.condition=wet", "rail.friction=0.09", "initial_speed=60 km/h"),
}


@pytest.mark.parametrize("kind", BALANCED)
def test_every_stop_comes_to_rest_and_conserves_energy_and_air(rig, kind):
    """Cleaning moves no energy: what the contacts lose is heat."""
    measures = rig.stop(*BALANCED[kind]).measures
    assert measures.stopped == 1.0
    assert abs(measures.energy_residual) < (1e-8 if BALANCED[kind][0] in (*CURVES, *LAYER) else 1e-9)
    assert abs(measures.air_residual) < 1e-9
    assert abs(measures.air_energy_residual) < 1e-9


def test_energy_ends_as_heat(rig):
    """On level track all of the kinetic energy goes into discs, contacts, dampers and running resistance."""
    end = rig.stop(DRY, **NO_RESISTANCE)
    heat = end.wheelsets.brake_heat.sum() + end.wheelsets.contact_loss.sum() + end.car.damper_loss
    p = rig.parameters(DRY, **NO_RESISTANCE)[0]
    assert heat == pytest.approx(0.5 * masses(p)[1] * p.initial_speed**2, rel=1e-3)
    assert end.wheelsets.brake_heat.sum() > 0.98 * heat


def test_lighter_braking_takes_longer(rig):
    distances = [rig.stop(DRY, f"brake.command={c} %").measures.braking_distance for c in (60, 80, 100)]
    assert distances[0] > distances[1] > distances[2]


def test_measures_are_those_of_the_recording(rig):
    """Taken from the trace at the controller's cycle with plain numpy."""
    overrides = ("rail.condition=wet", "rail.friction=0.08")
    stop = rig.stop(*overrides, every=20)
    p = rig.parameters(*overrides)[0]
    trace = rig.columns(*overrides)
    seen = slice(1, -1)
    time, speed = trace["time"][seen], trace["speed"][seen]
    moving = speed > p.moving_speed
    slide = trace["slide"][seen][moving]
    np.testing.assert_allclose(stop.wheelset_measures.maximum_slide, slide.max(axis=0), rtol=1e-12)
    openings = np.diff(trace["valve_command"][: seen.stop] == 2.0, axis=0) & (
        trace["valve_command"][seen] == 2.0
    )
    np.testing.assert_array_equal(stop.wheelset_measures.valve_actuations, openings.sum(axis=0))
    locked = trace["wheel_speed"][seen][moving] < p.locked_speed
    np.testing.assert_allclose(stop.wheelset_measures.locked_time, 0.01 * locked.sum(axis=0), rtol=1e-9)
    sliding = (slide > p.sliding_slide) & (slide * speed[moving, None] > p.sliding_slip)
    first = time[moving][sliding.any(axis=1).argmax()]
    assert stop.measures.sliding_time == first
    expected = np.interp(first + np.arange(11), trace["time"], trace["speed"])
    np.testing.assert_allclose(stop.measures.speed_after_sliding, expected, rtol=1e-9)


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
