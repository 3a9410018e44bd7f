"""The vehicle against a state space built here from its geometry, and against statics by hand."""

from dataclasses import dataclass

import control
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import expm

from uictest.core.physics.rail import force_and_slope
from uictest.core.translation import translate
from uictest.rig.model.balance import stored_energy
from uictest.rig.model.friction_brake import step_clamping
from uictest.rig.model.pneumatics import step_air
from uictest.rig.model.running_gear import HIGHEST_LOAD, bracket_slip

from ..plain_numbers import step

Array = NDArray[np.float64]
CREEP_DAMPING = 5e4
"""Creep force of one wheel per slip speed in the linear law that stands in for Polach's, N s/m."""
LEVEL = {"resistance_constant": 0.0, "resistance_linear": 0.0, "resistance_quadratic": 0.0, "gradient": 0.0}


def linear_creep(gradient, speed, limit, limit_slope, stiffness, *_):
    slip_speed = gradient[0] / stiffness
    return CREEP_DAMPING * slip_speed, CREEP_DAMPING


def still(*_):
    pass


LINEAR_STEP = translate(
    step, lambda function: function, {force_and_slope: linear_creep, step_air: still, step_clamping: still}
)
"""The rig's own step on a rail with linear creep, while the test prescribes the clamping forces."""

# Coordinates: body x, z, pitch; the same of the two bogies; x of the wheelsets; their angles of rotation.
BODY, BOGIES, WHEELSETS, ANGLES = 0, (3, 6), (9, 10, 11, 12), (13, 14, 15, 16)
FREEDOMS = 17
SPRUNG = slice(0, 13)
"""Coordinates with springs: all but the angles of rotation."""


@dataclass(frozen=True)
class Linear:
    """M q'' + C q' + K q = U torques: seventeen degrees of freedom."""

    mass: Array
    damping: Array
    stiffness: Array
    inputs: Array

    @property
    def system(self):
        """State space of the 13 sprung coordinates and 17 speeds, with the brake torques as input."""
        inverse = np.linalg.inv(self.mass)
        a = np.zeros((30, 30))
        a[:13, 13:26] = np.eye(13)
        a[13:, :13] = -(inverse @ self.stiffness)[:, SPRUNG]
        a[13:, 13:] = -inverse @ self.damping
        b = np.vstack([np.zeros((13, 4)), inverse @ self.inputs])
        return control.ss(a, b, np.eye(30), np.zeros((30, 4)))


def point(frame, ahead, above):
    """Rows that give the longitudinal and vertical displacement of a point of a frame."""
    along, up = np.zeros(FREEDOMS), np.zeros(FREEDOMS)
    along[[frame, frame + 2]] = 1.0, -above
    up[[frame + 1, frame + 2]] = 1.0, ahead
    return along, up


def linear_vehicle(p):
    """Energy method: each spring and damper adds k b b^T and c b b^T, b being the row of its deflection."""
    frames = [p.body_mass, p.body_mass, p.body_inertia] + 2 * [p.bogie_mass, p.bogie_mass, p.bogie_inertia]
    mass = np.diag([*frames, *4 * [p.wheelset_mass], *4 * [p.rotational_inertia]])
    damping, stiffness = np.zeros((2, FREEDOMS, FREEDOMS))
    inputs = np.zeros((FREEDOMS, 4))

    def connect(deflection, k, c):
        stiffness[:] += k * np.outer(deflection, deflection)
        damping[:] += c * np.outer(deflection, deflection)

    for bogie, ahead in zip(BOGIES, (p.half_pivot_distance, -p.half_pivot_distance), strict=True):
        for name in ("secondary", "link"):
            height = p.secondary_height if name == "secondary" else p.link_height
            along = (
                point(BODY, ahead, height - p.body_height)[0] - point(bogie, 0.0, height - p.bogie_height)[0]
            )
            if name == "link":
                connect(along, p.link_stiffness, p.link_damping)
            else:
                connect(along, p.secondary_longitudinal_stiffness, p.secondary_longitudinal_damping)
        up = point(BODY, ahead, 0.0)[1] - point(bogie, 0.0, 0.0)[1]
        connect(up, p.secondary_vertical_stiffness, p.secondary_vertical_damping)
    for i in range(4):
        bogie, ahead = BOGIES[i // 2], p.half_wheelbase * (1 - 2 * (i % 2))
        along, up = point(bogie, ahead, p.wheel_radius - p.bogie_height)
        along[WHEELSETS[i]] -= 1.0
        connect(along, p.primary_longitudinal_stiffness, p.primary_longitudinal_damping)
        connect(up, p.primary_vertical_stiffness, p.primary_vertical_damping)
        slip = np.zeros(FREEDOMS)
        slip[[WHEELSETS[i], ANGLES[i]]] = 1.0, -p.wheel_radius
        connect(slip, 0.0, 2.0 * CREEP_DAMPING)
        # A rolling wheel turns nose down: the pitch of the bogie adds to its rotation against the brake.
        inputs[[ANGLES[i], bogie + 2], i] = -1.0
    return Linear(mass, damping, stiffness, inputs)


def frames(bench):
    return [bench.car, *bench.bogies]


def state(bench):
    """State of the rig in the order of the state space."""
    positions = [x for f in frames(bench) for x in (f.position, f.height, f.pitch)]
    speeds = [x for f in frames(bench) for x in (f.speed, f.vertical_speed, f.pitch_rate)]
    positions += [w.position for w in bench.wheelsets]
    speeds += [w.speed for w in bench.wheelsets] + [w.rotation for w in bench.wheelsets]
    return np.array(positions + speeds)


def set_state(bench, x):
    values = iter(x.tolist())
    for frame in frames(bench):
        frame.position, frame.height, frame.pitch = next(values), next(values), next(values)
    for wheelset in bench.wheelsets:
        wheelset.position = next(values)
    for frame in frames(bench):
        frame.speed, frame.vertical_speed, frame.pitch_rate = next(values), next(values), next(values)
    for wheelset in bench.wheelsets:
        wheelset.speed = next(values)
    for wheelset in bench.wheelsets:
        wheelset.rotation = next(values)


def advance(bench, torques):
    p = bench.p
    per_force = p.calipers_per_wheelset * p.pads_per_caliper * p.reference_pad_friction * p.disc_radius
    for wheelset, torque in zip(bench.wheelsets, torques.tolist(), strict=True):
        wheelset.clamping_force = torque / per_force
        wheelset.friction = 1e3
    LINEAR_STEP(bench.car, bench.bogies, bench.wheelsets, p)


def one_step_matrix(bench):
    """The linear map of one step, found by displacing each state by one."""
    rolling = state(bench)
    columns = []
    for displaced in np.vstack([np.zeros(30), np.eye(30)]):
        set_state(bench, rolling + displaced)
        advance(bench, np.zeros(4))
        columns.append(state(bench))
    return np.array(columns[1:]).T - columns[0][:, None]


@pytest.fixture(name="level", params=["intercity-180", "manchester-benchmark", "crh380a"], scope="module")
def _level(request, rig):
    """Parameters of a vehicle on level track without running resistance, at a step in ms."""

    def parameters(step):
        overrides = (f"vehicle={request.param}", "rig.compensation=none", f"simulation.time_step={step} ms")
        return rig.parameters(*overrides, initial_speed=30.0, **LEVEL)[0]

    return parameters


def test_one_step_is_the_matrix_exponential_to_second_order(level, bench):
    """Local error of a first-order scheme: a quarter at half the step, in all thirty states."""

    def error(step):
        p = level(step)
        exact = expm(linear_vehicle(p).system.A * p.step)
        return float(np.abs(one_step_matrix(bench(p)) - exact).max() / np.abs(exact).max())

    assert error(0.01) < 1e-2
    assert error(0.01) == pytest.approx(0.25 * error(0.02), rel=0.1)


def test_eigenfrequencies_and_damping_at_the_base_step(level, bench):
    """Bounce, pitch and longitudinal modes: all that oscillate, against the continuous system."""
    p = level(0.5)
    exact = oscillating(linear_vehicle(p).system.poles())
    ours = oscillating(np.log(np.linalg.eigvals(one_step_matrix(bench(p))).astype(complex)) / 5e-4)
    assert exact.size >= 5
    np.testing.assert_allclose(np.abs(ours), np.abs(exact), rtol=0.02)
    np.testing.assert_allclose(ours.real / np.abs(ours), exact.real / np.abs(exact), atol=0.05)


def oscillating(poles):
    """One pole of each pair that oscillates below 100 Hz, by frequency."""
    chosen = poles[(poles.imag > 0.2) & (np.abs(poles) < 2.0 * np.pi * 100.0)]
    return chosen[np.argsort(np.abs(chosen))]


def test_irregular_braking_moves_the_vehicle_as_the_exact_discretisation_does(rig, bench):
    """Torques of their own on each wheelset, held for 50 ms each, which excite every mode."""
    count = 1600
    random = np.random.default_rng(2)
    torques = np.repeat(random.uniform(1000.0, 6000.0, (4, count // 100)), 100, axis=1)
    p = rig.parameters("simulation.time_step=0.5 ms", initial_speed=30.0, **LEVEL)[0]
    discrete = linear_vehicle(p).system.sample(5e-4, method="zoh")
    exact = control.forced_response(discrete, U=torques).outputs

    rolling = bench(p)
    at_rest = state(rolling)
    ours = []
    for k in range(count):
        ours.append(state(rolling) - at_rest)
        ours[-1][[0, 3, 6, 9, 10, 11, 12]] -= 30.0 * 5e-4 * k
        advance(rolling, torques[:, k])
    deviation = np.abs(np.array(ours).T - np.array(exact)).max(axis=1)
    size = np.abs(np.array(exact)).max(axis=1)
    # The symmetric car does not bounce: rounding alone moves that coordinate.
    bounces = size > 1e-9 * size.max()
    assert bounces.sum() == 28
    assert np.max(deviation[bounces] / size[bounces]) < 0.02
    assert np.max(deviation[~bounces]) < 1e-9


def test_stored_energy_is_the_quadratic_form_of_mass_and_stiffness(rig, bench):
    p = rig.parameters(initial_speed=30.0, **LEVEL)[0]
    model = linear_vehicle(p)
    displaced = bench(p)
    x = np.random.default_rng(4).normal(0.0, 0.01, 30)
    set_state(displaced, x)
    rates = x[13:]
    behind = np.append(x[:13], np.zeros(4)) - 0.5 * p.step * rates
    expected = 0.5 * (rates @ model.mass @ rates + behind @ model.stiffness @ behind)
    energy = stored_energy(displaced.car, displaced.bogies, displaced.wheelsets, displaced.p)
    assert energy == pytest.approx(expected, rel=1e-12)


@pytest.fixture(name="steady", scope="module")
def _steady(rig):
    """Parameters, deceleration and changes of wheelset load of a train that brakes evenly on a dry rail."""
    settings = {
        "secondary_height": 0.8,
        "link_height": 0.8,
        "pressure_noise": 0.0,
        "loadcell_noise": 0.0,
        **LEVEL,
    }
    overrides = ("rig.topology=four-caliper", "initial_speed=200 km/h")
    p = rig.parameters(*overrides, **settings)[0]
    trace = rig.columns(*overrides, **settings)
    late = (trace["speed"] > 2.0) & (trace["speed"] < 6.0)
    deceleration = -np.polyfit(trace["time"][late], trace["speed"][late], 1)[0]
    load = 2.0 * (trace["wheel_load"][late].mean(axis=0) - p.static_wheel_load)
    return p, float(deceleration), load


def test_weight_transfer_is_that_of_statics_and_all_loads_are_the_weight(steady):
    """Moments of the inertia forces about the rail, for the car as a whole and for each bogie."""
    p, a, load = steady
    height = p.secondary_height
    between_bogies = p.body_mass * a * (p.body_height - height) / (2.0 * p.half_pivot_distance)
    of_bogie = (
        0.5 * p.body_mass * a * height
        + a * (p.bogie_mass * p.bogie_height + 2.0 * p.wheelset_mass * p.wheel_radius)
        + 2.0 * p.rotational_inertia * a / p.wheel_radius
    ) / p.half_wheelbase
    signs = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
    expected = 0.5 * signs @ [between_bogies, of_bogie]
    np.testing.assert_allclose(load, expected, rtol=2e-3, atol=1e-3 * of_bogie)
    assert abs(load.sum()) < 1e-3 * np.abs(load).max()


def test_trailing_wheelsets_of_the_bogies_carry_least(rig):
    trace = rig.columns("initial_speed=120 km/h")
    braking = (trace["time"] > 5.0) & (trace["speed"] > 3.0)
    load = trace["wheel_load"][braking].mean(axis=0)
    assert set(np.argsort(load)[:2]) == {1, 3}


def test_contact_grows_with_the_load_as_hertz_says_up_to_a_highest_load(rig, bench):
    p = rig.parameters()[0]
    wheelset = bench(p).wheelsets[0]
    wheelset.friction = 0.3
    for load in (0.5, 1.0, HIGHEST_LOAD, 2.0 * HIGHEST_LOAD):
        wheelset.wheel_load = load * p.reference_load
        bracket_slip(wheelset, 0.0, p)
        grown = min(load, HIGHEST_LOAD) ** (2.0 / 3.0)
        assert wheelset.contact_stiffness == pytest.approx(p.creep_stiffness * grown, rel=1e-11)


LOCKING = ("rail.condition=wet", "rail.friction=0.09", "rig.wsp=bypassed")


def test_locked_wheels_decelerate_at_the_sliding_friction(rig):
    """mu(v) of the wheels that slide at the train's speed, times g, and no rotating mass with it."""
    trace = rig.columns(*LOCKING, **LEVEL)
    p = rig.parameters(*LOCKING, **LEVEL)[0]
    v = trace["speed"]
    locked = (trace["wheel_speed"] == 0.0).all(axis=1) & (v > 1.0)
    assert locked.sum() > 1000
    mu = 0.09 * ((1.0 - p.friction_ratio) * np.exp(-p.friction_decay * v) + p.friction_ratio)
    full_slide = p.creep_stiffness / (p.reference_load * mu)
    adhering = p.reduction_adhesion * full_slide
    shape = adhering / (1.0 + adhering**2) + np.arctan(p.reduction_slip * full_slide)
    sliding = 2.0 / np.pi * mu * shape
    np.testing.assert_allclose(trace["adhesion"][locked].mean(axis=1), sliding[locked], rtol=2e-3)
    stretch = np.flatnonzero(locked)[300:-100]
    ends = stretch[[0, -1]]
    mean = (v[ends[0]] - v[ends[1]]) / (trace["time"][ends[1]] - trace["time"][ends[0]])
    assert mean == pytest.approx(p.gravity * sliding[stretch].mean(), rel=2e-3)


def test_a_wheel_that_locks_stays_locked_without_chatter(rig):
    """At every step until the train stands: no turning back, no second start."""
    trace = rig.columns(*LOCKING, every=1)
    assert trace["wheel_speed"].min() == 0.0
    turning = trace["wheel_speed"] > 0.0
    assert np.all(np.abs(np.diff(turning.astype(int), axis=0)).sum(axis=0) == 1)


def test_a_locked_wheel_turns_again_once_the_brake_cannot_hold_it(rig, bench):
    """The rail's torque is 2 Q mu r; a brake of four fifths of it lets go, one of six fifths holds."""
    p = rig.parameters(*LOCKING, **LEVEL)[0]
    pressed = translate(step, lambda f: f, {step_air: still, step_clamping: still})
    per_force = p.calipers_per_wheelset * p.pads_per_caliper * p.reference_pad_friction * p.disc_radius
    speed = 15.0
    mu = 0.09 * ((1.0 - p.friction_ratio) * np.exp(-p.friction_decay * speed) + p.friction_ratio)
    for share, turns in ((1.2, False), (0.8, True)):
        sliding = bench(p)
        sliding.car.speed = speed
        for frame in (*sliding.bogies, *sliding.wheelsets):
            frame.speed = speed
        for wheelset in sliding.wheelsets:
            wheelset.rotation = 0.0
            wheelset.friction = 0.09
            wheelset.clamping_force = share * 2.0 * p.static_wheel_load * mu * p.wheel_radius / per_force
        for _ in range(40):
            pressed(sliding.car, sliding.bogies, sliding.wheelsets, sliding.p)
        assert all((wheelset.rotation > 0.0) == turns for wheelset in sliding.wheelsets)
