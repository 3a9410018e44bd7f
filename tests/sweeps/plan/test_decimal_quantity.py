"""Numbers with units: read and written without losing a digit."""

from decimal import Decimal

import pytest
from hypothesis import given, strategies as st

from uictest.plans.scenario.yaml.quantities import (
    DecimalQuantity,
    evenly_spaced,
    parse_decimal_quantity,
    rounded_decimal,
    spaced_by_step,
)


def test_number_and_unit():
    assert parse_decimal_quantity(" 1.1e-8 m3/(s  Pa) ") == DecimalQuantity(Decimal("1.1e-8"), "m3/(s Pa)")
    assert str(parse_decimal_quantity("1.1e-8 m3/(s Pa)")) == "0.000000011 m3/(s Pa)"
    assert str(parse_decimal_quantity("0.10")) == "0.10"


@pytest.mark.parametrize("text", ["", "km/h", "nan", "1..2", "--1"])
def test_what_is_no_amount(text):
    with pytest.raises(ValueError, match="is not a number with its unit"):
        parse_decimal_quantity(text)


def test_a_step_reaches_the_last_number_where_it_lands_on_it():
    assert [str(n) for n in spaced_by_step(Decimal("0.1"), Decimal("0.3"), Decimal("0.1"))] == [
        "0.1",
        "0.2",
        "0.3",
    ]
    assert [str(n) for n in spaced_by_step(Decimal(3), Decimal(0), Decimal(-2))] == ["3", "1"]


@given(st.integers(-1000, 1000), st.integers(-1000, 1000), st.integers(2, 50))
def test_even_numbers_keep_both_ends(first, last, count):
    numbers = evenly_spaced(Decimal(first) / 7, Decimal(last) / 7, count)
    assert len(numbers) == count
    assert float(numbers[0]) == pytest.approx(first / 7, abs=1e-7)
    assert float(numbers[-1]) == pytest.approx(last / 7, abs=1e-7)


@given(st.floats(1e-12, 1e12))
def test_a_computed_number_is_written_without_an_exponent(number):
    text = f"{rounded_decimal(number):f}"
    assert "e" not in text.lower()
    assert float(text) == pytest.approx(number, rel=1e-9)
