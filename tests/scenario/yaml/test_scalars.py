"""Plain scalars as YAML 1.2 reads them."""

import math

import pytest

from uictest.plans.scenario.yaml.parsing import scalar_value


@pytest.mark.parametrize(
    "text", ["on", "off", "yes", "no", "y", "12:30", "1_000", "0b11", "2026-01-01", "1e"]
)
def test_what_yaml_1_1_would_convert_is_a_text(text):
    assert scalar_value(text) == text


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e3", 1000.0),
        ("1", 1),
        ("010", 10),
        ("0o10", 8),
        ("0xff", 255),
        ("-.5", -0.5),
        ("5.", 5.0),
        ("true", True),
        ("False", False),
        ("~", None),
        ("", None),
        ("-.inf", -math.inf),
    ],
)
def test_core_schema(text, value):
    assert scalar_value(text) == value
    assert type(scalar_value(text)) is type(value)


def test_not_a_number_is_a_number():
    assert math.isnan(float(str(scalar_value(".nan"))))


def test_thousands_of_digits_are_no_integer():
    assert scalar_value("9" * 10_000) == math.inf
