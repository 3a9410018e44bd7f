"""The transfer function that made a record is found in it again."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.signal import cont2discrete

from uictest.rig.identification import UnsuitableRecordError, fitted_freely, identify_cylinder
from uictest.rig.identification.cylinder import assembled
from uictest.rig.identification.output_error import basis, sections
from uictest.rig.identification.record import applications

STEP = 0.001
FREQUENCIES = np.geomspace(0.05, 20.0, 60)


def excitation(duration=20.0, step=STEP):
    """A pressure that leaps between random levels at random times."""
    rng = np.random.default_rng(4)
    time = np.arange(round(duration / step) + 1) * step
    leaps = np.cumsum(rng.uniform(0.02, 0.5, 400))
    levels = rng.uniform(0.0, 4e5, len(leaps) + 1)
    levels[0] = 0.0
    return time, levels[np.searchsorted(leaps, time)]


def known(real=True):
    """A third-order lag with a fast part, or one with a pair of complex poles."""
    if real:
        return assembled(np.log([0.05, 0.32, 0.006]), np.array([0.3, 0.6, 0.1]), STEP)
    return assembled(np.log([0.3, 0.036, 0.0004]), np.array([0.2, 0.8, 0.1]), STEP)


@pytest.fixture(scope="module")
def found():
    """What is found in a short record of the known response."""
    time, tank = excitation(8.0)
    return identify_cylinder(time, tank, known().output(tank))


@pytest.fixture(scope="module")
def overshooting():
    """A system that overshoots by a tenth, its record, and what is found in it."""
    time, tank = excitation(12.0)
    truth = assembled(np.log([0.05, 0.02, 0.0004]), np.array([0.0, 1.0, 0.0]), STEP)
    return truth, time, tank, identify_cylinder(time, tank, truth.output(tank))


@pytest.mark.parametrize(("seed", "real"), [(1, True), (2, False)])
def test_a_known_response_is_recovered_within_a_per_cent_up_to_20_hz(seed, real):
    time, tank = excitation()
    truth = known(real)
    noise = 0.005 * tank.max() * np.random.default_rng(seed).standard_normal(len(tank))
    result = identify_cylinder(time, tank, truth.output(tank) + noise)
    expected = truth.response(FREQUENCIES)
    assert np.abs(result.transfer_function.response(FREQUENCIES) - expected).max() < 0.01
    assert result.fit > 95.0


def test_unity_gain_stability_and_a_better_model_than_none(found):
    result = found.transfer_function
    gain = sum(result.numerator) / (1.0 + sum(result.denominator))
    assert gain == pytest.approx(1.0, abs=1e-6)
    assert np.all(np.abs(result.poles) < 1.0)
    assert result.output(np.full(1000, 3e5)) == pytest.approx(3e5)
    assert found.largest_after < 0.01 * found.largest_before


def test_a_free_fit_follows_a_response_that_turns_back(overshooting):
    """What the bound of the shipped filter costs is seen beside it."""
    truth, time, tank, bounded = overshooting
    cylinder = truth.output(tank)
    free = fitted_freely(time, tank, cylinder)
    errors = [np.abs(each.output(tank) - cylinder).max() for each in (free, bounded.transfer_function)]
    assert errors[0] < 0.01 * tank.max() < errors[1]
    assert sum(free.numerator) / (1.0 + sum(free.denominator)) == pytest.approx(1.0, abs=1e-6)


def test_the_response_to_a_step_never_turns_back(overshooting):
    """The true system overshoots by a tenth: the hysteresis would keep that as force to standstill."""
    truth, _, _, result = overshooting
    step = np.concatenate([[0.0], np.ones(round(20.0 / STEP))])
    assert truth.output(step).max() > 1.1
    response = result.transfer_function.output(step)
    assert 0.99 < response.max() < 1.002
    assert np.all(np.maximum.accumulate(response) - response < 2e-3)
    assert result.largest_after < result.largest_before


@pytest.mark.parametrize(
    ("spoil", "reason"),
    [
        (lambda t, p: (t[:2000], p[:2000]), "too short"),
        (lambda t, p: (t, np.full_like(p, 3e5)), "no excitation"),
        (lambda t, p: (t, np.minimum(t * 1e5, 3e5)), "swings"),
        (lambda t, p: (t[::40], p[::40]), "needs? .* or less"),
        (lambda t, p: (np.where(t > 2.0, t + 0.01, t), p), "uneven sampling"),
        (lambda t, p: (t, np.where(t > 2.0, np.nan, p)), "not numbers"),
    ],
)
def test_a_record_that_cannot_support_it_is_refused_with_the_reason(spoil, reason):
    time, pressure = spoil(*excitation(6.0))
    with pytest.raises(UnsuitableRecordError, match=reason):
        identify_cylinder(time, pressure, pressure)


STEP_APPLICATIONS = 0.01


def ramps(*corners):
    times, levels = np.array(corners, dtype=float).T
    return np.interp(np.arange(round(times[-1] / STEP_APPLICATIONS)) * STEP_APPLICATIONS, times, levels)


def test_applications_begin_at_rest_and_end_before_their_release():
    tank = ramps((0, 0), (1, 0), (2, 3e5), (5, 3e5), (6, 0), (8, 0), (9, 2e5), (11, 2e5), (12, 0), (14, 0))
    first, second = applications(tank, tank, STEP_APPLICATIONS)
    assert first.start * STEP_APPLICATIONS == pytest.approx(1.0, abs=0.1)
    assert 1.9 < first.stop * STEP_APPLICATIONS < 5.1
    assert second.start * STEP_APPLICATIONS == pytest.approx(8.0, abs=0.1)
    assert 8.9 < second.stop * STEP_APPLICATIONS < 11.1
    short_release = ramps((0, 0), (1, 3e5), (2, 0), (2.2, 0), (3, 3e5), (5, 3e5))
    assert len(applications(short_release, short_release, STEP_APPLICATIONS)) == 1
    no_rest = ramps((0, 2e5), (5, 3e5))
    assert applications(no_rest, no_rest, STEP_APPLICATIONS) == [slice(0, len(no_rest))]


constants = st.floats(0.002, 5.0)


@given(constants, constants, constants, st.tuples(*[st.floats(-2.0, 2.0)] * 3))
def test_every_set_of_parameters_is_stable_with_unity_gain(first, second, third, weights):
    model = assembled(np.log([first, second + third, second * third]), np.array(weights), 0.0005)
    a1, a2, a3 = model.denominator
    jury = (abs(a3) < 1.0, 1.0 - a1 + a2 - a3 > 0.0, abs(a2 - a1 * a3) < 1.0 - a3 * a3)
    assert all(jury)
    assert sum(model.numerator) / (1.0 + sum(model.denominator)) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("poles", [(0.1, 0.5, 0.04), (0.01, 0.02, 0.001), (3.0, 0.4, 0.04)])
def test_the_sections_are_held_at_the_sampling_time(poles):
    time_constant, alpha, beta = poles
    exact = [
        cont2discrete(([1.0], [time_constant, 1.0]), 0.001),
        cont2discrete(([1.0], [beta, alpha, 1.0]), 0.001),
        cont2discrete(([alpha, 0.0], [beta, alpha, 1.0]), 0.001),
    ]
    for (b, a), (b_exact, a_exact, _) in zip(sections(np.log(poles), 0.001), exact, strict=True):
        assert a == pytest.approx(a_exact, abs=1e-12)
        assert b == pytest.approx(np.squeeze(b_exact), abs=1e-12)


def test_the_assembled_function_is_the_weighted_sum_of_the_sections():
    poles, weights = np.log([0.1, 0.5, 0.04]), np.array([0.3, -0.2, 0.5])
    samples = np.concatenate([np.zeros(5), np.linspace(0.0, 1.0, 500), np.full(500, 0.4)])
    expected = samples + basis(samples, sections(poles, 0.001), np.arange(len(samples))) @ weights
    assert assembled(poles, weights, 0.001).output(samples) == pytest.approx(expected, abs=1e-9)


def test_the_band_ends_where_the_gain_has_fallen_by_three_decibels():
    lag = assembled(np.log([0.1, 0.02, 0.0001]), np.array([1.0, 0.0, 0.0]), 0.0005)
    assert lag.band == pytest.approx(1.0 / (2.0 * np.pi * 0.1), rel=0.05)
