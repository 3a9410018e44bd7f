"""The caliper against its equation of equilibrium, solved by brute force, and what friction must do."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.optimize import brentq

from uictest.physics.caliper import clamping_force, stiffnesses, stroke_after

STEP = 5e-4


@dataclass(frozen=True)
class Caliper:
    piston_area: float = 0.01824
    preload: float = 700.0
    spring_rate: float = 1645.0
    coulomb_friction: float = 60.0
    load_friction: float = 0.055
    viscous_friction: float = 200.0
    clearance: float = 2.9e-3
    contact_stiffness: float = 8e6

    def contact(self, stroke: float) -> float:
        return self.contact_stiffness * max(stroke - self.clearance, 0.0)

    def friction(self, stroke: float) -> float:
        return self.coulomb_friction + self.load_friction * self.contact(stroke)

    def net_force(self, stroke: float, pressure: float) -> float:
        """Force on the piston without friction, N."""
        return pressure * self.piston_area - self.preload - self.spring_rate * stroke - self.contact(stroke)

    def pressure_at(self, stroke: float, direction: float) -> float:
        """Pressure at which the piston just moves in a direction, Pa."""
        return (direction * self.friction(stroke) - self.net_force(stroke, 0.0)) / self.piston_area

    def after(self, stroke: float, pressure: float, step: float = STEP) -> float:
        derived = stiffnesses(
            self.spring_rate, self.load_friction, self.viscous_friction, self.contact_stiffness, step
        )
        return stroke_after(
            stroke,
            pressure,
            self.piston_area,
            self.preload,
            self.coulomb_friction,
            self.clearance,
            *derived,
        )


CALIPER = Caliper()
SLOW = replace(CALIPER, viscous_friction=0.0)
strokes = st.floats(0.0, 4.5e-3)
pressures = st.floats(0.0, 5e5)


def brute_force(caliper: Caliper, stroke: float, pressure: float) -> float:
    """Root of the equation of motion in each direction; no motion where friction carries the difference."""
    for direction, end in ((1.0, 10.0), (-1.0, -10.0)):
        if direction * caliper.net_force(stroke, pressure) > caliper.friction(stroke):

            def balance(y: float, direction: float = direction) -> float:
                viscous = caliper.viscous_friction * (y - stroke) / STEP
                return caliper.net_force(y, pressure) - direction * caliper.friction(y) - viscous

            return max(float(brentq(balance, stroke, end, xtol=1e-15, rtol=1e-14)), 0.0)
    return stroke


def sweep(caliper: Caliper, pressures: Iterable[float]) -> np.ndarray:
    stroke = 0.0
    strokes = [stroke := caliper.after(stroke, p) for p in pressures]
    return np.array(strokes)


@given(strokes, pressures, st.floats(0.0, 1e4))
def test_one_step_solves_the_equation_of_motion(stroke: float, pressure: float, viscous: float) -> None:
    caliper = replace(CALIPER, viscous_friction=viscous)
    assert caliper.after(stroke, pressure) == pytest.approx(brute_force(caliper, stroke, pressure), abs=1e-11)


def test_a_random_pressure_is_followed_as_by_brute_force() -> None:
    history = np.abs(np.cumsum(np.random.default_rng(3).normal(0.0, 2e4, 400))) % 5e5
    expected, stroke = [], 0.0
    for p in history.tolist():
        stroke = brute_force(CALIPER, stroke, p)
        expected.append(stroke)
    np.testing.assert_allclose(sweep(CALIPER, history.tolist()), expected, rtol=0.0, atol=1e-10)


@given(strokes, st.floats(-0.999, 0.999), pressures)
def test_no_motion_while_friction_carries_the_difference(stroke: float, share: float, viscous: float) -> None:
    """However often it is pushed with less than the friction, the piston does not creep."""
    caliper = replace(CALIPER, viscous_friction=viscous)
    free = -caliper.net_force(stroke, 0.0)
    pressure = (free + share * caliper.friction(stroke)) / caliper.piston_area
    after = stroke
    for _ in range(50):
        after = caliper.after(after, pressure)
    assert after == stroke


@given(strokes, pressures)
def test_piston_never_leaves_its_seat_backwards(stroke: float, pressure: float) -> None:
    assert CALIPER.after(stroke, pressure) >= 0.0


@given(strokes, pressures, pressures)
def test_more_pressure_never_means_less_stroke(stroke: float, a: float, b: float) -> None:
    low, high = sorted((a, b))
    assert CALIPER.after(stroke, low) <= CALIPER.after(stroke, high)


def test_no_clamping_until_the_clearance_is_closed() -> None:
    """The spring, the friction and the clearance together give the pressure at which the pads touch."""
    touch = CALIPER.pressure_at(CALIPER.clearance, 1.0)
    strokes = sweep(SLOW, [0.999 * touch] * 3)
    force = clamping_force(float(strokes[-1]), CALIPER.clearance, CALIPER.contact_stiffness, 2.45)
    assert force == 0.0
    assert SLOW.after(0.0, 1.001 * touch) > CALIPER.clearance


def test_loop_is_as_wide_as_twice_the_friction() -> None:
    """At one and the same stroke, squeezing and releasing pressure differ by 2 (Fc + alpha N) / A."""
    rising = np.linspace(0.0, 4.5e5, 5001)
    up = sweep(SLOW, rising.tolist())
    both = sweep(SLOW, [*rising.tolist(), *rising[::-1].tolist()])
    down = both[rising.size :]
    stroke = 3.4e-3
    squeezing = np.interp(stroke, up, rising)
    releasing = np.interp(stroke, down[::-1], rising)
    expected = 2.0 * CALIPER.friction(stroke) / CALIPER.piston_area
    assert squeezing - releasing == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("caliper", [SLOW, CALIPER, replace(CALIPER, viscous_friction=1e4)])
def test_work_of_a_closed_loop_is_what_friction_turns_into_heat(caliper: Caliper) -> None:
    """The work of the air on the piston over a loop is positive and equals that of friction and damping."""
    time = STEP * np.arange(8001)
    pressure = 2.25e5 * (1.0 - np.cos(2.0 * math.pi * time / 2.0))
    strokes = sweep(caliper, pressure.tolist())
    loop = slice(4000, None)
    moved = np.diff(strokes[loop])
    work = float(np.sum(pressure[loop][1:] * moved) * caliper.piston_area)
    friction = np.array([caliper.friction(y) for y in strokes[loop][1:].tolist()])
    heat = float(np.sum(friction * np.abs(moved)) + caliper.viscous_friction / STEP * np.sum(moved**2))
    assert work > 0.0
    assert work == pytest.approx(heat, rel=0.02)


def test_quick_loops_are_wider_than_slow_ones() -> None:
    """Friction that grows with speed: WSP cycles and brake applications give different lines."""
    damped = replace(CALIPER, viscous_friction=2e4)

    def area(period: float) -> float:
        time = STEP * np.arange(round(2 * period / STEP) + 1)
        pressure = 3e5 + 1e5 * np.sin(2.0 * math.pi * time / period)
        half = time.size // 2
        strokes = sweep(damped, pressure.tolist())
        return float(np.sum(pressure[half + 1 :] * np.diff(strokes[half:])))

    assert area(0.2) > 1.05 * area(4.0)


def test_lever_multiplies_the_contact_force() -> None:
    assert clamping_force(3.9e-3, 2.9e-3, 8e6, 2.45) == pytest.approx(2.45 * 8e3)
