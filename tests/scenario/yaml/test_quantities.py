"""Quantities: exact factors, nothing guessed, the text kept; fields and models of them; decimals."""

import copy
import math
import pickle
from decimal import Decimal
from functools import cached_property
from typing import Annotated

import pytest
from hypothesis import given, strategies as st
from pydantic import BaseModel, ValidationError

from uictest.core.units import KINDS
from uictest.plans.scenario.yaml import Model
from uictest.plans.scenario.yaml.fields import of_kind
from uictest.plans.scenario.yaml.quantities import (
    DecimalQuantity,
    Quantity,
    QuantityError,
    count_by_step,
    evenly_spaced,
    parse_decimal_quantity,
    parse_quantity,
    rounded_decimal,
    spaced_by_step,
)

WITH_UNITS = [(kind.name, symbol) for kind in KINDS.values() for symbol in kind.units]


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("36 km/h", "speed", 10.0),
        ("36.0000000000000000000 km/h", "speed", 10.0),
        ("120km/h", "speed", 120 / 3.6),
        ("4.2 bar", "pressure", 4.2e5),
        ("20 degC", "temperature", 293.15),
        ("100 %", "share", 1.0),
        ("5 permille", "gradient", 0.005),
        ("300 L", "volume", 0.3),
        ("300 NL", "normal volume", 0.3),
        ("1 g", "acceleration", 9.80665),
        ("3.8 kN/bar", "force per pressure", 0.038),
        ("60 NL/min", "mass flow", 0.001185),
        ("1 dm3/(s bar)", "conductance", 1e-8),
        ("31.391e6 N/m", "stiffness", 31_391_000.0),
        ("8 kg  m2", "inertia", 8.0),
        ("-.5 m", "length", -0.5),
        ("1e3", "number", 1000.0),
        ("0.05 ms", "time", 5e-5),
    ],
)
def test_a_quantity_is_read_in_si(text, kind, value):
    quantity = parse_quantity(text, kind)
    assert quantity == pytest.approx(value, rel=1e-15)
    assert quantity.text == text
    assert quantity.unit == KINDS[kind].canonical
    assert quantity.source == "scenario"


def test_conversion_rounds_once():
    # 0.1 bar is 10 kPa exactly, although 0.1 is no binary number and 0.1 * 1e5 need not round to it.
    assert parse_quantity("0.1 bar", "pressure") == 10_000.0
    assert parse_quantity("0.3 ms", "time") == 0.0003


@given(st.sampled_from(WITH_UNITS), st.decimals(-1_000_000, 1_000_000, places=6, allow_nan=False))
def test_what_a_quantity_says_reads_back_as_the_same_quantity(unit, number):
    kind, symbol = unit
    quantity = parse_quantity(f"{number:f} {symbol}", kind)
    again = parse_quantity(quantity.text, kind)
    assert again == quantity
    assert (again.text, again.unit) == (quantity.text, quantity.unit)


@given(st.sampled_from(WITH_UNITS), st.decimals(1, 1000, places=3, allow_nan=False))
def test_units_differ_by_their_factor_alone(unit, number):
    kind, symbol = unit
    accepted = KINDS[kind].units[symbol]
    value = parse_quantity(f"{number:f} {symbol}", kind)
    assert value == pytest.approx(
        float(accepted.factor) * float(str(number)) + float(accepted.offset), rel=1e-12
    )


@given(st.text())
def test_any_text_is_a_finite_quantity_or_refused(text):
    try:
        quantity = parse_quantity(text, "speed")
    except QuantityError as error:
        assert error.message
    else:
        assert math.isfinite(quantity)


@pytest.mark.parametrize(
    ("text", "kind", "hint"),
    [
        ("120", "speed", "write `120 km/h` or `120 m/s`"),
        ("20", "temperature", "write `20 degC` or `20 K`"),
        ("90", "share", "write `90 %` or `90 permille`"),
        ("1.0", "share", "write `100 %` (a bare 1.0 is ambiguous)"),
        ("0.085", "share", "write `8.5 %` (a bare 0.085 is ambiguous)"),
        ("12", "inertia", "write `12 kg m2`"),
        ("4 Bar", "pressure", "did you mean 'bar'?"),
        ("80 kph", "speed", "did you mean 'km/h'?"),
        ("80 KM/H", "speed", "did you mean 'km/h'?"),
        ("1.5 m/s^2", "acceleration", "did you mean 'm/s2'?"),
        ("1.5 m/s²", "acceleration", "did you mean 'm/s2'?"),
        ("20 °C", "temperature", "did you mean 'degC'?"),
        ("8 kg*m^2", "inertia", "did you mean 'kg m2'?"),
        ("300 L", "normal volume", "did you mean 'NL'?"),
        ("9 %", "number", "write 0.09"),
        ("4,2 bar", "pressure", "write '4.2 bar', with a decimal point"),
        ("0.1 m", "number", "write 0.1"),
    ],
)
def test_the_hint_says_what_to_write(text, kind, hint):
    with pytest.raises(QuantityError) as caught:
        parse_quantity(text, kind)
    assert caught.value.hint.startswith(hint)


class Sample(BaseModel):
    pressure: Annotated[Quantity, of_kind("pressure", "> 0 bar .. 8 bar")]


def message(value):
    with pytest.raises(ValidationError) as caught:
        Sample.model_validate({"pressure": value})
    return caught.value.errors()[0]["msg"]


def test_bounds_are_told_as_written_and_another_kind_is_refused():
    assert message("0 bar") == "0 bar is out of range: it must be above 0 bar"
    assert message("900 kPa") == "900 kPa is out of range: it must be at most 8 bar"
    assert Sample.model_validate({"pressure": "800 kPa"}).pressure == 8e5
    assert message(Quantity(3.0, "3 m", "m")) == "'3 m' is not a pressure"


def test_a_value_with_its_source_is_written_out_and_read_back_and_copied_with_it():
    sample = Sample.model_validate({"pressure": {"value": "3 bar", "source": "maker"}})
    assert (sample.pressure, sample.pressure.source) == (3e5, "maker")
    sample = Sample.model_validate({"pressure": {"value": "3 bar", "source": "maker"}})
    again = Sample.model_validate(sample.model_dump())
    assert (again.pressure, again.pressure.text, again.pressure.source) == (3e5, "3 bar", "maker")
    quantity = parse_quantity("4 bar", "pressure", "maker")
    for twin in (copy.copy(quantity), copy.deepcopy(quantity)):
        assert isinstance(twin, Quantity)
        assert (twin, twin.text, twin.unit, twin.source) == (4e5, "4 bar", "Pa", "maker")


@pytest.mark.parametrize(
    "value", [{"value": "3 bar"}, {"value": "3 bar", "source": 1}, {"x": 1}, True, None, ()]
)
def test_anything_else_is_refused(value):
    assert message(value).startswith("expected a pressure")


RANGED = {"value": "3 bar", "range": ["2 bar", "4 bar"]}


@pytest.mark.parametrize("prior", ["uniform", "log-uniform"])
def test_a_range_states_its_prior_and_keeps_it_through_copies_and_files(prior):
    sample = Sample.model_validate({"pressure": {**RANGED, "prior": prior}})
    assert sample.pressure.prior == prior
    assert Sample.model_validate(sample.model_dump()).pressure.prior == prior
    assert copy.deepcopy(sample.pressure).prior == prior
    assert pickle.loads(pickle.dumps(sample.pressure)).prior == prior


def test_a_range_without_a_prior_is_uniform_and_one_that_it_cannot_have_is_refused():
    assert Sample.model_validate({"pressure": RANGED}).pressure.prior == "uniform"
    assert message({**RANGED, "prior": "normal"}) == "unknown prior 'normal'"
    assert message({**RANGED, "prior": ["uniform"]}).startswith("unknown prior")
    assert message({"value": "3 bar", "source": "maker", "prior": "uniform"}) == "a prior without a range"
    # 253 K is above zero, but the logarithm is that of the number as written, which is what is drawn.
    frost = {"value": "5 degC", "range": ["-20 degC", "30 degC"], "prior": "log-uniform"}
    with pytest.raises(ValidationError, match="a log-uniform prior of a range from -20 degC"):
        Temperature.model_validate({"temperature": frost})


class Temperature(BaseModel):
    temperature: Annotated[Quantity, of_kind("temperature", "-50 degC .. 100 degC")]


def test_numbers_with_units_are_decimal_and_steps_reach_the_last_one_where_they_land_on_it():
    assert parse_decimal_quantity(" 1.1e-8 m3/(s  Pa) ") == DecimalQuantity(Decimal("1.1e-8"), "m3/(s Pa)")
    assert str(parse_decimal_quantity("1.1e-8 m3/(s Pa)")) == "0.000000011 m3/(s Pa)"
    assert str(parse_decimal_quantity("0.10")) == "0.10"
    assert [str(n) for n in spaced_by_step(Decimal("0.1"), Decimal("0.3"), Decimal("0.1"))] == [
        "0.1",
        "0.2",
        "0.3",
    ]
    assert [str(n) for n in spaced_by_step(Decimal(3), Decimal(0), Decimal(-2))] == ["3", "1"]


@pytest.mark.parametrize("text", ["", "km/h", "nan", "1..2", "--1"])
def test_what_is_no_amount(text):
    with pytest.raises(ValueError, match="is not a number with its unit"):
        parse_decimal_quantity(text)


@given(st.integers(-50, 50), st.integers(-50, 50), st.integers(-7, 7))
def test_steps_are_counted_without_being_made(first, last, step):
    reached = range(first, last + (1 if step > 0 else -1), step) if step else ()
    count = count_by_step(Decimal(first), Decimal(last), Decimal(step))
    assert count == len(reached)
    if count:
        assert len(spaced_by_step(Decimal(first), Decimal(last), Decimal(step))) == count


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


class Counted(Model):
    number: int

    @cached_property
    def doubled(self):
        return [2 * self.number]


@pytest.mark.parametrize("deep", [False, True])
def test_a_cached_property_of_a_copy_is_that_of_its_own_values(deep):
    original = Counted(number=1)
    assert original.doubled == [2]
    assert original.model_copy(update={"number": 3}, deep=deep).doubled == [6]
    assert original.doubled == [2]


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, Counted.model_copy])
def test_a_copy_is_equal_whether_or_not_something_was_worked_out(copied):
    original = Counted(number=1)
    assert original.doubled == [2]
    assert copied(original) == original == Counted(number=1)
    assert copied(original).doubled == [2]
