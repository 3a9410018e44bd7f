"""The caliper against its equation of equilibrium, solved by brute force, and what friction must do."""

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import control
import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.optimize import brentq
from scipy.signal import lfilter

from uictest.core.physics.caliper import (
    clamping_force,
    force_after,
    line,
    memory,
    output,
    phase_share,
    stiffnesses,
    stroke_after,
)

STEP = 5e-4


@dataclass(frozen=True)
class Caliper:
    piston_area: float = 0.01824
    preload: float = 700.0
    spring_rate: float = 1645.0
    coulomb_friction: float = 60.0
    load_friction: float = 0.055
    viscous_friction: float = 200.0
    contact_friction: float = 2e4
    clearance: float = 2.9e-3
    contact_stiffness: float = 8e6

    def compression(self, stroke):
        return max(stroke - self.clearance, 0.0)

    def contact(self, stroke):
        return self.contact_stiffness * self.compression(stroke)

    def friction(self, stroke):
        return self.coulomb_friction + self.load_friction * self.contact(stroke)

    def net_force(self, stroke, pressure):
        """Force on the piston without friction, N."""
        return pressure * self.piston_area - self.preload - self.spring_rate * stroke - self.contact(stroke)

    def pressure_at(self, stroke, direction):
        """Pressure at which the piston just moves in a direction, Pa."""
        return (direction * self.friction(stroke) - self.net_force(stroke, 0.0)) / self.piston_area

    def after(self, stroke, pressure, step=STEP):
        derived = stiffnesses(
            self.spring_rate,
            self.load_friction,
            self.viscous_friction,
            self.contact_friction,
            self.contact_stiffness,
            step,
        )
        return stroke_after(
            stroke, pressure, self.piston_area, self.preload, self.coulomb_friction, self.clearance, *derived
        )


CALIPER = Caliper()
SLOW = replace(CALIPER, viscous_friction=0.0, contact_friction=0.0)
strokes = st.floats(0.0, 4.5e-3)
pressures = st.floats(0.0, 5e5)
dampings = st.floats(0.0, 1e5)


def brute_force(caliper, stroke, pressure):
    """Root of the equation of motion in each direction; no motion where friction carries the difference."""
    for direction, end in ((1.0, 10.0), (-1.0, -10.0)):
        if direction * caliper.net_force(stroke, pressure) > caliper.friction(stroke):

            def balance(y, direction=direction):
                squeezed = caliper.compression(y) - caliper.compression(stroke)
                viscous = caliper.viscous_friction * (y - stroke) + caliper.contact_friction * squeezed
                return caliper.net_force(y, pressure) - direction * caliper.friction(y) - viscous / STEP

            return max(float(brentq(balance, stroke, end, xtol=1e-15, rtol=1e-14)), 0.0)
    return stroke


def sweep(caliper, pressures):
    stroke = 0.0
    strokes = [stroke := caliper.after(stroke, p) for p in pressures]
    return np.array(strokes)


@given(strokes, pressures, st.floats(0.0, 1e4), dampings)
def test_one_step_solves_the_equation_of_motion(stroke, pressure, viscous, contact):
    caliper = replace(CALIPER, viscous_friction=viscous, contact_friction=contact)
    assert caliper.after(stroke, pressure) == pytest.approx(brute_force(caliper, stroke, pressure), abs=1e-11)


def test_a_random_pressure_is_followed_as_by_brute_force():
    history = np.abs(np.cumsum(np.random.default_rng(3).normal(0.0, 2e4, 400))) % 5e5
    expected, stroke = [], 0.0
    for p in history.tolist():
        stroke = brute_force(CALIPER, stroke, p)
        expected.append(stroke)
    np.testing.assert_allclose(sweep(CALIPER, history.tolist()), expected, rtol=0.0, atol=1e-10)


@given(strokes, st.floats(-0.999, 0.999), pressures, dampings)
def test_no_motion_while_friction_carries_the_difference(stroke, share, viscous, contact):
    """However often it is pushed with less than the friction, the piston does not creep."""
    caliper = replace(CALIPER, viscous_friction=viscous, contact_friction=contact)
    free = -caliper.net_force(stroke, 0.0)
    pressure = (free + share * caliper.friction(stroke)) / caliper.piston_area
    after = stroke
    for _ in range(50):
        after = caliper.after(after, pressure)
    assert after == stroke


@given(strokes, pressures, pressures)
def test_more_pressure_never_means_less_stroke_and_no_piston_leaves_its_seat_backwards(stroke, a, b):
    low, high = sorted((a, b))
    assert 0.0 <= CALIPER.after(stroke, low) <= CALIPER.after(stroke, high)


def test_no_clamping_until_the_clearance_is_closed_and_then_that_of_the_lever():
    """The spring, the friction and the clearance together give the pressure at which the pads touch."""
    touch = CALIPER.pressure_at(CALIPER.clearance, 1.0)
    strokes = sweep(SLOW, [0.999 * touch] * 3)
    force = clamping_force(float(strokes[-1]), CALIPER.clearance, CALIPER.contact_stiffness, 2.45)
    assert force == 0.0
    assert SLOW.after(0.0, 1.001 * touch) > CALIPER.clearance
    assert clamping_force(3.9e-3, 2.9e-3, 8e6, 2.45) == pytest.approx(2.45 * 8e3)


def test_loop_is_as_wide_as_twice_the_friction():
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


def ramp(start, end, duration):
    return np.linspace(start, end, round(duration / STEP) + 1).tolist()


def loop_width(caliper, duration, stroke):
    """Pressure between squeezing and releasing at a stroke, each from 0 to 5 bar within a duration, Pa."""
    rising = ramp(0.0, 5e5, duration)
    strokes = sweep(caliper, [*rising, *rising[::-1]])
    up, down = strokes[: len(rising)], strokes[len(rising) :]
    return float(np.interp(stroke, up, rising) - np.interp(stroke, down[::-1], rising))


@pytest.mark.parametrize("duration", [0.5, 1.0, 4.0])
def test_friction_of_the_contact_widens_the_loop_by_the_speed_of_the_pads(duration):
    """By cN (z' squeezing + z' releasing) / A; under a ramp of p, z' = A p' / (kc (1 +- alpha) + k)."""
    caliper = replace(SLOW, contact_friction=7e4)
    force_rate = caliper.piston_area * 5e5 / duration
    speeds = [
        force_rate / (caliper.contact_stiffness * (1.0 + side * caliper.load_friction) + caliper.spring_rate)
        for side in (1.0, -1.0)
    ]
    widened = loop_width(caliper, duration, 3.4e-3) - loop_width(SLOW, duration, 3.4e-3)
    assert widened == pytest.approx(caliper.contact_friction * sum(speeds) / caliper.piston_area, rel=0.02)


def test_free_travel_does_not_feel_the_friction_of_the_contact():
    """Not in a bit: the pads do not touch, however quick the pressure is."""
    damped = replace(CALIPER, contact_friction=1e5)
    below = 0.999 * CALIPER.pressure_at(CALIPER.clearance, 1.0)
    history = [*ramp(0.0, below, 0.05), *ramp(below, 0.0, 0.05)]
    assert sweep(damped, history).tolist() == sweep(CALIPER, history).tolist()


@pytest.mark.parametrize("end", [1.5e5, 3e5, 4e5])
@pytest.mark.parametrize("start", [0.0, 5e5])
def test_where_the_piston_comes_to_rest_does_not_depend_on_the_friction_of_the_contact(start, end):
    """Squeezed up or released down to a pressure and held there: all it does is to arrive later."""
    history = [*ramp(0.0, start, 0.2), *[start] * 2000, *[end] * 2000]
    at_rest = [
        float(sweep(replace(CALIPER, contact_friction=friction), history)[-1]) for friction in (0.0, 2e4, 1e5)
    ]
    assert at_rest == pytest.approx([at_rest[0]] * 3, abs=1e-9)
    direction = 1.0 if end > start else -1.0
    assert CALIPER.pressure_at(at_rest[0], direction) == pytest.approx(end, rel=1e-4)


@pytest.mark.parametrize(
    "caliper", [SLOW, CALIPER, replace(CALIPER, viscous_friction=1e4), replace(CALIPER, contact_friction=1e5)]
)
def test_work_of_a_closed_loop_is_what_friction_turns_into_heat(caliper):
    """The work of the air on the piston over a loop is positive and equals that of friction and damping."""
    time = STEP * np.arange(8001)
    pressure = 2.25e5 * (1.0 - np.cos(2.0 * math.pi * time / 2.0))
    strokes = sweep(caliper, pressure.tolist())
    loop = slice(4000, None)
    moved = np.diff(strokes[loop])
    work = float(np.sum(pressure[loop][1:] * moved) * caliper.piston_area)
    friction = np.array([caliper.friction(y) for y in strokes[loop][1:].tolist()])
    squeezed = np.diff([caliper.compression(y) for y in strokes[loop].tolist()])
    damping = caliper.viscous_friction * moved**2 + caliper.contact_friction * squeezed**2
    heat = float(np.sum(friction * np.abs(moved) + damping / STEP))
    assert work > 0.0
    assert work == pytest.approx(heat, rel=0.02)


@pytest.mark.parametrize("damped", [replace(SLOW, viscous_friction=2e4), replace(SLOW, contact_friction=2e4)])
def test_quick_loops_are_wider_than_slow_ones(damped):
    """Friction that grows with speed: WSP cycles and brake applications give different lines."""

    def area(period):
        time = STEP * np.arange(round(2 * period / STEP) + 1)
        pressure = 3e5 + 1e5 * np.sin(2.0 * math.pi * time / period)
        half = time.size // 2
        strokes = sweep(damped, pressure.tolist())
        return float(np.sum(pressure[half + 1 :] * np.diff(strokes[half:])))

    assert area(0.2) > 1.05 * area(4.0)


SQUEEZING = (0.042, -1874.0)
RELEASING = (0.047, -1580.0)
pressure = st.floats(0.0, 5e5)
histories = st.lists(pressure, min_size=1, max_size=30)


def played(history, force=0.0):
    for p in history:
        force = force_after(force, line(p, *SQUEEZING), line(p, *RELEASING))
    return force


@given(histories)
def test_force_lies_between_the_lines_and_is_never_negative(history):
    assert 0.0 <= line(history[-1], *SQUEEZING) <= played(history) <= line(history[-1], *RELEASING)


@given(st.lists(pressure, min_size=2, max_size=15), st.integers(1, 7))
def test_force_depends_on_the_path_and_not_on_its_pace(history, parts):
    """Rate independence: the same turning points, reached in more steps, leave the same force."""
    slow = history[:1]
    for a, b in pairwise(history):
        slow += [a + (b - a) * k / parts for k in range(1, parts)] + [b]
    assert played(slow) == played(history)


@given(st.lists(pressure, max_size=10), pressure, pressure)
def test_inner_loop_returns_to_where_it_began(history, turn, inner):
    """Return-point memory: a closed excursion, repeated, closes on itself."""
    once = played([*history, turn, inner, turn])
    assert played([turn, inner, turn] * 3, once) == played([turn, inner, turn], once)


@given(histories, st.floats(-100.0, 100.0))
def test_force_stays_where_it_is_while_the_pressure_turns(history, turn):
    force = played(history)
    p = max(history[-1] + turn, 0.0)
    if line(p, *SQUEEZING) < force < line(p, *RELEASING):
        assert played([p], force) == force


def test_rising_pressure_follows_the_squeezing_line_falling_the_releasing_one_and_crossed_ones_give_one():
    assert played([0.0, 3e5]) == line(3e5, *SQUEEZING)
    assert played([0.0, 4e5, 3e5]) == line(3e5, *RELEASING)
    # Below their crossing identified lines are in the wrong order; the squeezing line then holds alone.
    assert force_after(0.0, squeezing=50.0, releasing=40.0) == 50.0
    assert force_after(90.0, squeezing=50.0, releasing=40.0) == 50.0


@given(st.floats(0.0, 1.0), st.sampled_from([0.0, 1.0]), st.floats(1e-4, 1.0))
def test_phase_changes_no_faster_than_allowed_and_arrives(share, acting, step):
    after = phase_share(share, acting, step)
    assert abs(after - share) <= step * (1.0 + 1e-12)
    assert abs(after - acting) <= max(abs(share - acting) - step, 0.0) + 1e-12


POLES = np.exp(-5e-4 / np.array([30e-3, 8e-3, 3e-3]))
DENOMINATOR = np.poly(POLES)
NUMERATOR = DENOMINATOR.sum() * np.array([0.4, 0.3, 0.2, 0.1])


def filtered(inputs):
    memories = [0.0, 0.0, 0.0, 0.0]
    outputs = []
    for u in inputs.tolist():
        y = output(u, memories[0], NUMERATOR[0])
        for i in range(3):
            memories[i] = memory(u, y, NUMERATOR[i + 1], DENOMINATOR[i + 1], memories[i + 1])
        outputs.append(y)
    return np.array(outputs)


def test_random_and_constant_inputs_are_filtered_as_scipy_does():
    inputs = np.random.default_rng(1).normal(2e5, 1e5, 4000)
    ours = filtered(inputs)
    np.testing.assert_allclose(ours, lfilter(NUMERATOR, DENOMINATOR, inputs), rtol=1e-12, atol=1e-6)
    assert filtered(np.full(4000, 3.8e5))[-1] == pytest.approx(3.8e5, rel=1e-12)


def test_step_response_is_that_of_the_transfer_function_in_control():
    system = control.tf(NUMERATOR, DENOMINATOR, 5e-4)
    response = control.step_response(system, T=5e-4 * np.arange(400))
    np.testing.assert_allclose(filtered(np.ones(400)), np.squeeze(response.outputs), rtol=1e-9, atol=1e-12)
    assert np.all(np.abs(system.poles()) < 1.0)
