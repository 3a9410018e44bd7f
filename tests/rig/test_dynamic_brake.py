"""The dynamic brake and its blending with the friction brake: closed forms, limits, what takes over when."""

import numpy as np
import pytest

MOTORS = "brake.dynamic={force: 60 kN, power: 1.6 MW}"
WEAK = "brake.dynamic={force: 24 kN, power: 400 kW, wheelsets: [1, 3]}"
POWER_LIMITED = "brake.dynamic={force: 40 kN, power: 300 kW}"
HEAVY_ROTORS = tuple(
    f"vehicle.wheelsets.{number}.rotational_inertia={inertia} kg m2"
    for number, inertia in ((1, 300), (3, 200))
)
BYPASSED = ("rig.wsp=bypassed", "rig.topology=four-caliper")
COASTING = (
    *BYPASSED,
    (
        "vehicle.wheelsets={1: {brake_force: 0 %}, 2: {brake_force: 0 %}, 3: {brake_force: 0 %},"
        " 4: {brake_force: 0 %}}"
    ),
    "vehicle.running_resistance={constant: 0 N, linear: 0 N s/m, quadratic: 0 N s2/m2}",
    "simulation.maximum_duration=120 s",
)
"""Nothing but the motors slows this car."""
SLIPPERY = ("rail.condition=wet", "rail.friction=0.08")
FAILING = "faults=[{at: 60 km/h, part: dynamic-brake, kind: failed}]"


def when_at(columns, speed):
    """Time and distance at which the train comes down to a speed in m/s, between two samples."""
    order = slice(None, None, -1)
    falling = columns["speed"][order]
    return tuple(float(np.interp(speed, falling, columns[name][order])) for name in ("time", "distance"))


def force_at_rims(columns, channel):
    return columns[channel].sum(axis=1) / 0.43


@pytest.mark.parametrize(("rotors", "inertia"), [((), 4.0 * 123.0), (HEAVY_ROTORS, 2.0 * 123.0 + 500.0)])
def test_a_car_braked_at_constant_power_follows_the_closed_form_down_to_10_kmh(rig, rotors, inertia):
    """t = m (v0^2 - v1^2) / (2 P) and s = m (v0^3 - v1^3) / (3 P), with the mass of what turns."""
    power = 120e3
    motors = f"brake.dynamic={{force: 900 kN, power: {power} W}}"
    stop = rig.columns(*COASTING, *rotors, "initial_speed=80 km/h", motors)
    mass = rig.case().scenario.vehicle.total_mass + inertia / 0.43**2
    fast, slow = 60.0 / 3.6, 10.0 / 3.6
    (t_0, s_0), (t_1, s_1) = when_at(stop, fast), when_at(stop, slow)
    assert t_1 - t_0 == pytest.approx(mass * (fast**2 - slow**2) / (2.0 * power), rel=2e-3)
    assert s_1 - s_0 == pytest.approx(mass * (fast**3 - slow**3) / (3.0 * power), rel=2e-3)


def test_it_never_stops_a_car_alone(rig):
    stop = rig.stop(*COASTING, "initial_speed=20 km/h", "brake.dynamic={force: 60 kN, power: 1.6 MW}")
    assert stop.measures.stopped == 0.0
    assert stop.measures.end_speed == pytest.approx(5.0 / 3.6, rel=1e-3)


@pytest.mark.parametrize("topology", ["four-caliper", "one-caliper"])
@pytest.mark.parametrize(
    "brake", [(), ("brake.command=50 %",), ("brake.position=P", "initial_speed=160 km/h")]
)
@pytest.mark.parametrize("motors", [MOTORS, WEAK, POWER_LIMITED])
def test_both_brakes_together_give_what_is_demanded(rig, motors, brake, topology):
    """Within 3 % from one second after the demand has built up to the fade-out, by the torque on wheelsets.

    The demand is the force of a squeezing caliper at the pressure of the command, from its own numbers.
    """
    overrides = ("rig.wsp=bypassed", f"rig.topology={topology}", *brake)
    alone, blended = rig.columns(*overrides), rig.columns(*overrides, motors)
    scenario = rig.case(*overrides).scenario
    caliper, disc = scenario.rig.caliper, scenario.brake.system.disc
    pressure = alone["demanded_pressure"].max()
    net = pressure * caliper.piston_area - caliper.preload - caliper.spring_rate * caliper.clearance
    clamping = caliper.lever_ratio * (net - caliper.coulomb_friction) / (1.0 + caliper.load_friction)
    faces = 4.0 * disc.calipers_per_wheelset * disc.pads_per_caliper
    demand = faces * disc.pad_friction * clamping * disc.mean_radius / 0.43
    built_up = alone["time"][np.argmax(alone["demanded_pressure"] > 0.999 * pressure)] + 1.0
    steady = (blended["time"] > built_up) & (blended["speed"] > 10.0 / 3.6)
    assert steady.sum() > 100
    assert force_at_rims(blended, "brake_torque")[steady] == pytest.approx(demand, rel=0.03)
    assert force_at_rims(blended, "dynamic_torque")[steady].max() > 0.4 * demand


@pytest.mark.parametrize("response_time", ["10 ms", "0.3 s", "2 s"])
def test_a_blended_stop_is_as_long_as_one_with_friction_alone(rig, response_time):
    """What motors are still to build up is not counted on."""
    overrides = (*BYPASSED, "initial_speed=120 km/h")
    motors = f"brake.dynamic={{force: 60 kN, power: 1.6 MW, response_time: {response_time}}}"
    distance = rig.stop(*overrides, motors).measures.end_distance
    assert distance == pytest.approx(rig.stop(*overrides).measures.end_distance, rel=5e-3)


def test_the_demanded_pressure_does_not_hunt_through_the_loop(rig):
    """A relieved brake changes sides once; in the fade-out it is squeezed again."""
    stop = rig.columns(*BYPASSED, "initial_speed=120 km/h", POWER_LIMITED)
    steady = (stop["time"] > 3.0) & (stop["speed"] > 10.0 / 3.6)
    assert np.abs(np.diff(stop["demanded_pressure"][steady])).max() < 5e3


def test_friction_alone_brakes_below_the_fade_out_and_wheelsets_without_a_motor(rig):
    stop = rig.columns(*BYPASSED, MOTORS)
    slow = stop["speed"] < 5.0 / 3.6 - 0.05
    assert np.all(stop["dynamic_torque"][slow] == 0.0)
    assert np.all(stop["dynamic_torque"][stop["speed"] > 10.0 / 3.6][-1] > 0.0)
    of_two = rig.columns(*BYPASSED, WEAK)["dynamic_torque"]
    assert np.all(of_two[:, [1, 3]] == 0.0)
    assert np.all(of_two.max(axis=0)[[0, 2]] > 0.0)


def test_after_a_failure_the_friction_brake_takes_over(rig):
    stop = rig.columns(*BYPASSED, MOTORS, FAILING)
    failed = stop["speed"] < 60.0 / 3.6 - 0.02
    assert np.all(stop["dynamic_torque"][failed] == 0.0)
    later = failed & (stop["time"] > stop["time"][failed][0] + 2.0)
    full = rig.columns(*BYPASSED)["demanded_pressure"].max()
    assert stop["demanded_pressure"][later] == pytest.approx(full)


def test_a_controller_that_cannot_reduce_it_loses_it_with_its_first_hold_or_vent(rig):
    overrides = ("controller=slip-band", *SLIPPERY)
    stop = rig.columns(*overrides, MOTORS)
    acted = np.flatnonzero((stop["valve_command"] > 0.0).any(axis=1))[0]
    assert stop["dynamic_torque"][acted].sum() > 0.0
    gone = stop["time"] > stop["time"][acted] + 3.0
    assert stop["dynamic_torque"][gone].max() < 1e-3 * stop["dynamic_torque"].max()
    full = rig.columns(*overrides)["demanded_pressure"].max()
    assert stop["demanded_pressure"][gone][-1] == pytest.approx(full)


def test_motors_that_give_next_to_nothing_change_next_to_nothing(rig):
    without = rig.stop(*BYPASSED).measures
    weakest = rig.stop(*BYPASSED, "brake.dynamic={force: 100 N, power: 1 kW}").measures
    assert weakest.end_distance == pytest.approx(without.end_distance, rel=2e-3)
    assert weakest.end_distance != without.end_distance


def test_the_motors_alone_make_a_wheelset_slide_and_never_lock_it(rig):
    """Faded out they hold nothing; on a better rail it rolls again."""
    places = (
        "{position: 0 m, friction: 0.02}, {position: 200 m, friction: 0.02}, {position: 202 m, friction: 0.3}"
    )
    stop = rig.columns(
        *BYPASSED,
        *("initial_speed=60 km/h", "rail.condition=wet", f"rail.friction={{points: [{places}]}}"),
        *("brake.command=30 %", MOTORS),
    )
    on_bad_rail, later = stop["distance"] < 190.0, (stop["distance"] > 230.0) & (stop["speed"] > 3.0)
    assert 5.0 / 3.6 < stop["wheel_speed"][on_bad_rail].min() < 10.0 / 3.6
    assert stop["slide"][later][-1].max() < 0.1


def test_the_share_of_the_energy_that_the_motors_take_is_what_they_turn(rig):
    """Force over distance, from the recording, against the ledger inside the energy balance."""
    stop = rig.columns(*BYPASSED, MOTORS)
    turned = np.trapezoid((stop["dynamic_torque"] * stop["wheel_speed"]).sum(axis=1) / 0.43, stop["time"])
    whole = 0.5 * rig.case().scenario.vehicle.total_mass * stop["speed"][0] ** 2
    assert 0.6 < turned / whole < 1.05
