"""Quantiles against scipy's distributions."""

import numpy as np
import pytest
from scipy import stats
from scipy.special import erfcx

from uictest.plans.scenario.expansion import FARTHEST_END, Distribution
from uictest.plans.sweeps.sampling import quantile

SHARES = np.linspace(0.0, 0.999, 50)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"uniform": ["2 m", "6 m"]}, stats.uniform(2, 4).ppf),
        ({"log-uniform": [0.1, 10]}, stats.loguniform(0.1, 10).ppf),
        ({"triangular": [1, 2, 5]}, stats.triang(0.25, 1, 4).ppf),
        ({"triangular": [0, 4, 4]}, stats.triang(1.0, 0, 4).ppf),
        (
            {"normal": {"mean": 1, "deviation": 2, "lower": 0, "upper": 4}},
            stats.truncnorm(-0.5, 1.5, 1, 2).ppf,
        ),
    ],
)
def test_quantiles(given, expected):
    found = quantile(Distribution.model_validate(given))(SHARES)
    assert found == pytest.approx(expected(SHARES), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("name", Distribution.model_fields)
def test_every_distribution_shows_an_example_that_it_accepts(name):
    field = Distribution.model_fields[name]
    (example,) = field.examples or ()
    assert Distribution.model_validate({field.alias or name: example}).form == name


def test_a_choice_gives_places():
    places = quantile(Distribution(choice=("a", "b", "c")))(np.array([0.0, 0.34, 0.99, 1.0]))
    assert places.tolist() == [0.0, 1.0, 2.0, 2.0]


TAILS = [
    (0.2, 0.01, 0.9, 0.95),
    (32, 0.5, 36.1, 40),
    (0, 1, 0, 3),
    (0, 1, 9, 9.001),
    (0, 1, 20, 1e60),
    (0, 1, 1000, 1001),
]
"""Mean, deviation, lower and upper end: above the mean, the last ones far."""


def drawn(normal, shares=SHARES):
    mean, deviation, lower, upper = normal
    given = {"mean": mean, "deviation": deviation, "lower": lower, "upper": upper}
    return quantile(Distribution.model_validate({"normal": given}))(shares)


def mirrored(normal):
    mean, deviation, lower, upper = normal
    return -mean, deviation, -upper, -lower


def beyond(value, low):
    """The probability to lie beyond a value for those that lie beyond `low`: Q(x) / Q(low)."""
    ratio = erfcx(value / np.sqrt(2.0)) / erfcx(low / np.sqrt(2.0))
    return ratio * np.exp(-(value - low) * (value + low) / 2.0)


@pytest.mark.parametrize("normal", TAILS)
def test_a_tail_of_a_normal_has_its_closed_form(normal):
    mean, deviation, lower, upper = normal
    low, high = (lower - mean) / deviation, (upper - mean) / deviation
    value = (drawn(normal) - mean) / deviation
    found = (1.0 - beyond(value, low)) / (1.0 - beyond(min(high, low + 100.0), low))
    assert found == pytest.approx(SHARES, abs=1e-6)


@pytest.mark.parametrize("normal", [*TAILS, *map(mirrored, TAILS), (1, 2, 0, 4), (0, 1, -9, 9)])
def test_a_normal_keeps_its_ends_and_rises(normal):
    *_, lower, upper = normal
    values = drawn(normal, np.array([*SHARES, 1.0 - 2.0**-53, 1.0]))
    assert [values[0], values[-1]] == pytest.approx([lower, upper])
    assert np.all((values >= lower) & (values <= upper))
    assert np.all(np.diff(values[:-2]) > 0.0)


@pytest.mark.parametrize("normal", TAILS)
def test_the_lower_tail_mirrors_the_upper(normal):
    shares = np.arange(1, 64) / 64.0
    assert np.array_equal(drawn(mirrored(normal), shares), -drawn(normal, 1.0 - shares))


def test_values_far_from_the_mean_crowd_at_the_nearer_end():
    # Beyond z deviations the normal falls as an exponential of mean 1/z deviations.
    assert drawn((0.2, 0.01, 0.9, 0.95)).mean() == pytest.approx(0.9 + 0.01 / 70.0, rel=1e-5)


@pytest.mark.parametrize("end", [FARTHEST_END - 1.0, -FARTHEST_END + 1.0])
def test_the_farthest_end_that_is_accepted_has_a_distribution_still(end):
    low, high = sorted((end, np.copysign(FARTHEST_END + 9.0, end)))
    excess = abs(drawn((0, 1, low, high), np.array([0.5]))[0] - end)
    assert excess == pytest.approx(np.log(2.0) / FARTHEST_END, rel=1e-3)
