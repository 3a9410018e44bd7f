"""The transfer function that made a record is found in it again."""

import numpy as np
import pytest

from uictest.rig.identification import UnsuitableRecordError, fitted_freely, identify_cylinder
from uictest.rig.identification.cylinder import assembled

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
def short():
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


def test_unity_gain_at_rest_and_stability_hold_by_parametrisation(short):
    result = short.transfer_function
    gain = sum(result.numerator) / (1.0 + sum(result.denominator))
    assert gain == pytest.approx(1.0, abs=1e-6)
    assert np.all(np.abs(result.poles) < 1.0)
    assert result.output(np.full(1000, 3e5)) == pytest.approx(3e5)


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


def test_the_model_is_better_than_none_on_what_was_held_out(short):
    assert short.largest_after < 0.01 * short.largest_before


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
