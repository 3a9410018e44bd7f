"""The planar vehicle, and one wheelset on the rail: slip, lock, and scipy's stiff integrator beside them."""

import math
from dataclasses import dataclass, field
from itertools import islice, pairwise

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.integrate import solve_ivp

from uictest.core.physics.rail import creep_force
from uictest.core.physics.vehicle import (
    SLOWEST_CREEP,
    gradient_force,
    kinetic_energy,
    locked_force,
    longitudinal,
    lowest_slip,
    refined_slip,
    running_resistance,
    spring_energy,
    suspension_force,
    turning_direction,
    vertical,
)

length = st.floats(-15.0, 15.0)


@given(length, length, st.floats(-1.0, 1.0), st.floats(-0.1, 0.1))
def test_points_move_as_on_a_rigid_body_that_lifts_its_nose_a_little(ahead, above, x, z):
    """The linear part of a rotation by a small angle."""
    angle = 1e-6
    turned_x = ahead * math.cos(angle) - above * math.sin(angle)
    turned_z = ahead * math.sin(angle) + above * math.cos(angle)
    assert longitudinal(x, angle, above) == pytest.approx(x + turned_x - ahead, abs=1e-10)
    assert vertical(z, angle, ahead) == pytest.approx(z + turned_z - above, abs=1e-10)


def test_springs_dampers_and_a_car_have_the_forces_and_energies_of_their_laws():
    k, d, h = 5e6, 0.01, 1e-6
    slope = (spring_energy(k, d + h) - spring_energy(k, d - h)) / (2 * h)
    assert suspension_force(k, 0.0, d, 0.0) == pytest.approx(slope, rel=1e-9)
    assert suspension_force(0.0, 2e4, 0.3, 0.5) == 1e4
    # 45 t at 33.3 m/s: 25 MJ.
    assert kinetic_energy(45e3, 120 / 3.6) == pytest.approx(25e6)
    # A tonne on ten per mille.
    assert gradient_force(1000.0, 0.010, 9.80665) == pytest.approx(98.0665)


@given(st.floats(-80.0, 80.0))
def test_resistance_is_daviss_and_always_against_the_motion(v):
    force = running_resistance(v, 530.0, 7.0, 0.9)
    if v == 0.0:
        assert force == 0.0
    else:
        assert force * v > 0.0
        assert abs(force) == pytest.approx(530.0 + 7.0 * abs(v) + 0.9 * v * v, rel=1e-12)


DRY = (0.55, 0.40, 0.60, 1.00, 0.40)
WET = (0.30, 0.40, 0.20, 0.30, 0.10)
SLIPPERY = (0.09, 0.40, 0.20, 0.30, 0.10)
LOAD = 55e3
STIFFNESS = 8.2e6
STEP = 5e-4
laws = st.sampled_from([DRY, WET, SLIPPERY])


def rail_force(slip, speed, law):
    """Force of both wheels, odd in the slip."""
    size = creep_force(abs(slip), max(abs(speed), SLOWEST_CREEP), LOAD, STIFFNESS, *law)[0]
    return math.copysign(2.0 * size, slip)


def refinements(start, free, softness, speed, law):
    """Estimate and bracket of the slip speed before and after each Newton step, in sizes."""
    slip, low, high = start, lowest_slip(free, softness, LOAD, law[0]), free
    while True:
        yield slip, low, high
        force, slope = creep_force(slip, max(abs(speed), SLOWEST_CREEP), LOAD, STIFFNESS, *law)
        slip, low, high = refined_slip(slip, low, high, free, softness, force, slope)


def slip_after(start, free, softness, speed, law):
    """Slip speed two Newton steps after the last one, as the running gear takes them."""
    direction = -1.0 if free < 0.0 else 1.0
    steps = refinements(max(direction * start, 0.0), direction * free, softness, speed, law)
    return direction * next(islice(steps, 2, None))[0]


@dataclass
class Wheelset:
    """A wheelset that carries its part of a car, stepped as the equations of the module say."""

    law: tuple[float, ...]
    speed: float
    mass: float = 11_000.0
    inertia: float = 123.0
    radius: float = 0.43
    step: float = STEP
    rotation: float = field(init=False)
    misfits: list[float] = field(default_factory=list)

    def __post_init__(self):
        self.rotation = self.speed / self.radius

    @property
    def slip(self):
        return self.speed - self.radius * self.rotation

    def advance(self, torque):
        softness = self.step * (1.0 / self.mass + self.radius**2 / self.inertia)
        free = self.slip + self.step * self.radius * torque / self.inertia
        slip = slip_after(self.slip, free, softness, self.speed, self.law)
        creep = (free - slip) / softness
        self.misfits.append(abs(creep - rail_force(slip, self.speed, self.law)) / (2.0 * LOAD * self.law[0]))
        self.speed -= self.step * creep / self.mass
        self.rotation += self.step / self.inertia * (self.radius * creep - torque)


@given(st.floats(-30.0, 30.0), st.floats(0.0, 40.0), st.floats(0.0, 40.0), laws)
def test_slip_is_odd_and_reached_by_a_force_that_the_rail_can_give(start, free, speed, law):
    """Whatever the iterations start from, the force lies between none and the friction limit."""
    softness = 1e-6
    slip = slip_after(start, free, softness, speed, law)
    assert slip_after(-start, -free, softness, -speed, law) == -slip
    assert 0.0 <= (free - slip) / softness <= 2.0 * LOAD * law[0] * (1.0 + 1e-6) + 1e-6


@given(st.floats(0.0, 30.0), st.floats(0.0, 40.0), st.floats(0.0, 40.0), laws)
def test_a_newton_step_narrows_the_bracket_around_the_root(start, free, speed, law):
    """Wherever it starts: too little slip speed at the lower end, too much at the upper one."""
    softness = 1e-6

    def excess(slip):
        return slip + softness * rail_force(slip, speed, law) - free

    steps = list(islice(refinements(start, free, softness, speed, law), 8))
    for (_, low, high), (slip, narrow_low, narrow_high) in pairwise(steps):
        assert low <= narrow_low <= slip <= narrow_high <= high
        assert excess(narrow_low) <= 1e-12
        assert excess(narrow_high) >= -1e-12


@given(st.floats(0.0, 40.0), st.floats(1.0, 40.0), laws)
def test_newton_steps_end_at_the_root(free, speed, law):
    """Where the creep law has one root: above a walking pace."""
    softness = 1e-6
    slip = next(islice(refinements(0.0, free, softness, speed, law), 60, None))[0]
    assert slip + softness * rail_force(slip, speed, law) == pytest.approx(free, abs=1e-9)


def braked_and_released(law, speed):
    """Misfits of the creep law, over the friction limit, while a wheelset is locked and released."""
    wheelset = Wheelset(law, speed, mass=1e9)
    for k in range(4000):
        wheelset.advance(8000.0 * min(k / 800, 1.0) * (k < 2400))
        wheelset.rotation = max(wheelset.rotation, 0.0)
    return wheelset.misfits


@pytest.mark.parametrize("law", [DRY, WET, SLIPPERY])
@pytest.mark.parametrize("speed", [30.0, 3.0])
def test_slip_solves_its_equation(law, speed):
    """Two Newton steps from the last slip speed meet the creep law at every step."""
    misfits = braked_and_released(law, speed)
    assert max(misfits) < 2e-3
    assert np.mean(misfits) < 1e-6


@pytest.mark.parametrize("law", [DRY, WET, SLIPPERY])
@pytest.mark.parametrize("speed", [0.3, 0.05])
def test_slip_solves_its_equation_below_a_walking_pace(law, speed):
    """Only the step in which a locked wheel begins to roll again may miss it; the next one has it back."""
    misfits = np.array(braked_and_released(law, speed))
    assert np.count_nonzero(misfits > 1e-2) <= 1
    assert np.mean(misfits) < 1e-4


def deviation_from_scipy(law, torque, step):
    """Largest difference of the slip speed, m/s, over a second in which the brake torque rises."""

    def slopes(t, y):
        speed, rotation = y
        force = rail_force(speed - 0.43 * rotation, speed, law)
        return [-force / 11_000.0, (0.43 * force - torque * min(t / 0.5, 1.0)) / 123.0]

    wheelset = Wheelset(law, 20.0, step=step)
    ours = []
    for k in range(round(1.0 / step)):
        wheelset.advance(torque * min((k + 1) * step / 0.5, 1.0))
        ours.append(wheelset.slip)
    time = step * np.arange(1, len(ours) + 1)
    start = [20.0, 20.0 / 0.43]
    exact = solve_ivp(slopes, (0.0, time[-1]), start, t_eval=time, method="Radau", rtol=1e-8, atol=1e-10)
    return float(np.max(np.abs(ours - (exact.y[0] - 0.43 * exact.y[1]))))


@pytest.mark.parametrize(("law", "torque"), [(DRY, 6000.0), (WET, 6000.0), (SLIPPERY, 4200.0)])
def test_slip_follows_a_stiff_integrator(law, torque):
    """Rolling with micro-slip on the first two rails, running into a deep slide on the third."""
    error = deviation_from_scipy(law, torque, STEP)
    assert error < 5e-3
    assert deviation_from_scipy(law, torque, 0.5 * STEP) < 0.6 * error


@given(st.floats(0.0, 50.0), st.floats(-0.1, 50.0), st.floats(0.0, 1e5))
def test_sliding_friction_stops_a_locked_wheelset_but_never_turns_it(speed, free_speed, friction):
    """Speed after the step: between the free speed and standstill."""
    softness = STEP / 1850.0
    force = locked_force(speed, free_speed, friction, softness)
    assert locked_force(-speed, -free_speed, friction, softness) == -force
    after = free_speed - softness * force
    assert min(free_speed, 0.0) - 1e-12 <= after <= max(free_speed, 0.0) + 1e-12


def test_locked_wheelset_feels_its_sliding_friction():
    """The change of the force within a step is that of the speed."""
    softness = STEP / 1850.0
    force = locked_force(20.0, 20.0, 9900.0, softness)
    assert force == pytest.approx(9900.0 * (20.0 - softness * force) / 20.0, rel=1e-12)


@pytest.mark.parametrize(
    ("rotation", "speed", "sense"), [(3.0, -1.0, 1.0), (-3.0, 1.0, -1.0), (0.0, 5.0, 1.0), (0.0, -5.0, -1.0)]
)
def test_a_wheelset_turns_as_it_turns_or_as_the_rail_would_turn_it(rotation, speed, sense):
    assert turning_direction(rotation, speed) == sense
