"""Quantities: exact factors, nothing guessed, and the text kept."""

import copy
import math

import pytest
from hypothesis import given, strategies as st

from uictest.core.units import KINDS
from uictest.plans.scenario.yaml.quantities import Quantity, QuantityError, parse_quantity

WITH_UNITS = [(kind.name, symbol) for kind in KINDS.values() for symbol in kind.units]


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("36 km/h", "speed", 10.0),
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


def test_copies_keep_text_unit_and_source():
    quantity = parse_quantity("4 bar", "pressure", "maker")
    for twin in (copy.copy(quantity), copy.deepcopy(quantity)):
        assert isinstance(twin, Quantity)
        assert (twin, twin.text, twin.unit, twin.source) == (4e5, "4 bar", "Pa", "maker")
