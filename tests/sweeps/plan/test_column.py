"""Values of many cases have the texts and the numbers that one case has."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.units import KINDS
from uictest.plans.scenario.yaml import parse_quantity
from uictest.plans.scenario.yaml.quantities import quantity_text, rounded_decimal, rounded_text
from uictest.plans.sweeps.column import ParameterValue, drawn_column, listed_column

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
