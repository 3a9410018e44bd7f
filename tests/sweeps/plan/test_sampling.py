"""Points are a function of seed and number alone, their values those of the distribution."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy import stats
from scipy.special import erfcx
from scipy.stats import qmc

from uictest.core.units import KINDS
from uictest.plans.scenario.expansion import FARTHEST_END, Distribution
from uictest.plans.scenario.yaml import parse_quantity
from uictest.plans.scenario.yaml.quantities import quantity_text, rounded_decimal, rounded_text
from uictest.plans.sweeps.column import ParameterValue, drawn_column, listed_column
from uictest.plans.sweeps.sampling import points, quantile

METHODS = ["random", "sobol", "latin-hypercube", "saltelli"]


@pytest.mark.parametrize("method", METHODS)
@given(data=st.data())
def test_any_points_are_those_of_the_whole(method, data):
    rows = 64 * 5 if method == "saltelli" else 64
    whole = points(method, 64, 3, 7, np.arange(rows))
    some = np.array(data.draw(st.lists(st.integers(0, rows - 1), min_size=1, max_size=20)))
    assert np.array_equal(points(method, 64, 3, 7, some), whole[some])


@pytest.mark.parametrize("method", METHODS)
def test_another_seed_gives_other_points_inside_the_cube(method):
    one, other = (points(method, 32, 2, seed, np.arange(32)) for seed in (1, 2))
    assert not np.array_equal(one, other)
    assert one.min() >= 0.0
    assert one.max() < 1.0


@pytest.mark.parametrize("method", METHODS)
def test_no_points_are_none_of_the_whole(method):
    assert points(method, 64, 3, 7, np.arange(0)).shape == (0, 3)


def test_samples_are_those_of_their_method():
    drawn = points("random", 3000, 2, 0, np.arange(3000))
    assert np.unique(drawn, axis=0).shape == (3000, 2)
    assert np.mean(drawn, axis=0) == pytest.approx([0.5, 0.5], abs=0.03)
    expected = qmc.Sobol(3, scramble=True, rng=5).random(16)
    assert np.array_equal(points("sobol", 16, 3, 5, np.arange(16)), expected)
    drawn = points("latin-hypercube", 20, 3, 0, np.arange(20))
    for column in drawn.T:
        assert sorted((column * 20).astype(int)) == list(range(20))
    rows = points("saltelli", 8, 2, 0, np.arange(8 * 4)).reshape(8, 4, 2)
    a, b, first, second = rows.transpose(1, 0, 2)
    assert np.array_equal(first, np.stack([b[:, 0], a[:, 1]], axis=1))
    assert np.array_equal(second, np.stack([a[:, 0], b[:, 1]], axis=1))


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


DRAWN = (
    st.floats(1e-16, 1e14)
    | st.floats(-1e6, -1e-12)
    | st.floats(1.0, 10.0)
    | st.builds(
        lambda digits, power: float(f"{digits}5e{power}"), st.integers(10**9, 10**10), st.integers(-22, 3)
    )
    | st.sampled_from([0.0, 3.0, 1e-5, 9.9999999999e-6, 1e10, 9999999999.5, 0.99999999995])
)
"""Numbers of all magnitudes, whole ones, and such as lie in the middle of two numbers of ten digits."""
UNITS = [(kind.name, unit) for kind in KINDS.values() for unit in ([""] if kind.bare else kind.units)]


@given(st.floats(-1e14, 1e14) | st.floats(-1e-3, 1e-3) | st.sampled_from([0.0, -0.0, 9999999999.5, 1e10]))
def test_a_rounded_number_is_written_as_its_decimal(number):
    assert rounded_text(number) == quantity_text(rounded_decimal(number), "")


@given(st.sampled_from(UNITS), st.lists(DRAWN, max_size=5))
def test_a_drawn_number_is_that_of_its_text(unit_of_kind, numbers):
    kind, unit = unit_of_kind
    column = drawn_column(np.array(numbers, float), unit, kind)
    for place, number in enumerate(numbers):
        text = f"{rounded_text(number)} {unit}".rstrip()
        assert column.texts[place] == column[place].text == text
        assert column.numbers[place] == parse_quantity(text, kind) == column[place].content


def test_numbers_without_a_kind_are_taken_one_by_one():
    column = drawn_column(np.array([3.0, 0.5]), "", "")
    assert [value.content for value in column] == [3, 0.5]
    assert column.numbers.tolist() == [3.0, 0.5]


@pytest.mark.parametrize(
    ("contents", "numbers"),
    [
        ([0.1, 0.2], [0.2, 0.1, 0.2]),
        ([7, 0.5], [0.5, 7.0, 0.5]),
        ([True, 0.1], [0.1, None, 0.1]),
        (["P", "R"], [None, None, None]),
    ],
)
def test_listed_values_have_a_number_where_they_are_one(contents, numbers):
    choices = [ParameterValue(str(content), content) for content in contents]
    column = listed_column(choices).take(np.array([1, 0, 1]))
    assert [None if np.isnan(number) else number for number in column.numbers] == numbers
    assert column.texts == [str(contents[k]) for k in (1, 0, 1)]
    assert column.take(np.array([1])).texts == [str(contents[0])]
    assert column.take(np.array([1]))[0].content == contents[0]
