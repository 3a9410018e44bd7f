"""The reference distance against closed forms, an independent integration and the rig itself."""

from math import atan, exp, isnan, pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

from uictest.plans.scenario import load
from uictest.rig import assemble, reference_distances, simulate

G = 9.80665
SCENARIO = """
schema: uictest/scenario/1
name: stop
initial_speed: 120 km/h
brake: {command: 100 %, position: R}
rail: {condition: wet, friction: 0.09}
"""
CLEANING = """
schema: uictest/scenario/1
name: cleaned
initial_speed: 120 km/h
brake: {command: 100 %, position: R}
rail:
  condition: wet
  friction: 0.08
  cleaning: {energy: 5300 J/m, recovered_friction: 0.28, reach: 0.5 m, carry_over: 0.5}
"""


@pytest.fixture
def case(tmp_path):
    def read(*overrides, text=SCENARIO, seed=None):
        path = tmp_path / "stop.yaml"
        path.write_text(text)
        return load([path], overrides, seed)[0]

    return read


def reference(case):
    inputs = assemble(case)
    given = inputs.parameters, inputs.wheelset_parameters, inputs.rail
    return float(reference_distances(*(np.array([each]) for each in given))[0])


def adhesion(slide, speed, rail, load):
    """Polach's law, written out: force of one wheel over its load at a slide."""
    curve, contact = rail.condition, rail.condition.contact
    semi_axes = contact.semi_axis_longitudinal * contact.semi_axis_lateral
    area = semi_axes * (load / contact.reference_wheel_load) ** (2 / 3)
    stiffness = 0.25 * contact.shear_modulus * pi * area * contact.kalker_coefficient
    fall = curve.friction_ratio + (1 - curve.friction_ratio) * exp(-curve.friction_decay * slide * speed)
    friction = rail.friction * fall
    gradient = stiffness * slide / (load * friction)
    adhering = curve.reduction_adhesion * gradient
    return 2 / pi * friction * (adhering / (1 + adhering**2) + atan(curve.reduction_slip * gradient))


def integrated(case, slide):
    """The distance at a slide by a solver of scipy, for a rail that remembers nothing."""
    scenario = case.scenario
    vehicle, brake, caliper = scenario.vehicle, scenario.brake, scenario.rig.caliper
    mass, wheel, disc = vehicle.total_mass, vehicle.wheelset, brake.system.disc
    position = brake.system.positions["R"]
    turning = wheel.rotational_inertia / wheel.radius**2
    drag = vehicle.running_resistance

    def brake_force(time):
        share = min(max((time - position.dead_time) / position.fill_time, 0.0), 1.0)
        push = share * position.maximum_pressure * caliper.piston_area - caliper.preload
        push -= caliper.coulomb_friction + caliper.spring_rate * caliper.clearance
        spread = caliper.spring_rate + caliper.contact_stiffness * (1 + caliper.load_friction)
        clamping = caliper.lever_ratio * caliper.contact_stiffness * max(push, 0.0) / spread
        rubbing = disc.calipers_per_wheelset * disc.pads_per_caliper * disc.pad_friction * clamping
        return 4 * rubbing * disc.mean_radius / wheel.radius

    def change(time, state):
        _, speed = state
        resistance = drag.constant + drag.linear * speed + drag.quadratic * speed**2
        outside = resistance + mass * G * scenario.rail.gradient
        rolling = (brake_force(time) + outside) / (mass + 4 * turning)
        sliding = mass * G * adhesion(slide, speed, scenario.rail, mass * G / 8) + outside
        return speed, -min(rolling, sliding / mass)

    stands = lambda time, state: state[1] - 1e-6  # noqa: E731
    stands.terminal = True
    begin = [0.0, float(scenario.initial_speed)]
    solved = solve_ivp(change, (0, 300), begin, events=stands, rtol=1e-8, atol=1e-8, max_step=0.2)
    return solved.y[0, -1]


@pytest.mark.parametrize("overrides", [(), ("rail.gradient=10 permille",), ("rail.friction=0.13",)])
def test_it_is_the_shortest_of_an_independent_integration_over_the_creep_law(case, overrides):
    chosen = case(*overrides)
    best = minimize_scalar(lambda slide: integrated(chosen, slide), bounds=(0.01, 0.4), method="bounded")
    assert reference(chosen) == pytest.approx(best.fun, rel=2e-3)


def test_on_a_dry_rail_it_is_the_stop_itself(case):
    dry = case("rail.condition=dry", "rail.friction=0.3")
    stop = simulate(dry).measures
    assert stop.reference_distance == pytest.approx(stop.braking_distance, rel=2e-3)


def test_without_a_fall_of_the_friction_the_deepest_slide_is_the_best_and_the_distance_v2_over_2_a(case):
    """The creep force then only grows with the slide: at 40 % it is nearly the friction limit all the way."""
    even = case("rail.condition.friction_ratio=1", "rail.friction=0.05")
    rail, load = even.scenario.rail, even.scenario.vehicle.total_mass * G / 8
    drag = even.scenario.vehicle.running_resistance
    mean = (drag.constant + drag.quadratic * (120 / 3.6) ** 2 / 2) / even.scenario.vehicle.total_mass
    deceleration = G * adhesion(0.4, 20.0, rail, load) + mean
    # The brake has built up to this little after 0.1 s and a part of 0.8 s.
    built_up = (120 / 3.6) * 0.35
    assert reference(even) == pytest.approx((120 / 3.6) ** 2 / (2 * deceleration) + built_up, rel=1e-2)


def test_a_rail_that_is_cleaned_shortens_it_at_most_to_that_of_a_clean_rail(case):
    at_once = case("rail.cleaning.energy=1 J/m", "rail.cleaning.recovered_friction=0.11", text=CLEANING)
    clean = case("rail.friction=0.11")
    assert reference(at_once) == pytest.approx(reference(clean), rel=3e-3)
    # Nothing, half and all of it left to the next wheelset; at most as on the clean rail.
    distances = [reference(case(f"rail.cleaning.carry_over={share}", text=CLEANING)) for share in (0, 0.5, 1)]
    assert distances == sorted(distances, reverse=True)
    assert distances[0] > 1.02 * distances[1] > 1.04 * distances[2]
    assert distances[2] > reference(case("rail.friction=0.28"))
    assert distances[0] < reference(case("rail.friction=0.08"))


def test_neither_controller_nor_seed_nor_sensors_move_a_bit_of_it_but_a_random_rail_does(case):
    own = reference(case())
    assert reference(case("controller=slip-band")) == own
    assert reference(case(seed=7)) == own
    assert simulate(case("controller=slip-band", seed=7)).measures.reference_distance == own
    varied = [
        reference(case("rail.condition=wet-varied", "rail.friction=null", seed=seed)) for seed in (1, 2, 1)
    ]
    assert varied[0] == varied[2] != varied[1]


def test_a_gradient_counts_as_the_weight_on_it(case):
    """Of a given rail: v^2 / (2 s) differs by g i."""
    level, up, down = (
        reference(case(f"rail.gradient={i} permille", "rail.condition.friction_ratio=1")) for i in (0, 5, -5)
    )
    means = [(120 / 3.6) ** 2 / (2 * distance) for distance in (down, level, up)]
    assert np.diff(means) == pytest.approx([5e-3 * G, 5e-3 * G], rel=0.04)


@pytest.mark.parametrize(
    "more",
    [
        "until: 40 km/h",
        "faults: [{at: 3 s, part: brake, kind: cut-out, wheelset: 2}]",
        "drag: {speed: 100 km/h, duration: 10 s}",
        "sanders: [{wheelset: 1, when: sliding, density: 7.5 g/m}]",
    ],
)
def test_it_is_of_a_stop_to_standstill_by_what_the_rail_is_alone(case, more):
    assert isnan(reference(case(text=SCENARIO + more)))
