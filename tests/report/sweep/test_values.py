import numpy as np
import pytest
from pydantic import TypeAdapter

from uictest.report import DrawnInterval, SweptValue, WrittenValue
from uictest.report.sweep.values import interval_indices, range_label

ADAPTER = TypeAdapter(SweptValue)


@pytest.mark.parametrize(
    ("value", "text", "number", "unit"),
    [
        (WrittenValue("80 km/h"), "80 km/h", 80.0, "km/h"),
        (WrittenValue("0.12"), "0.12", 0.12, ""),
        (WrittenValue("one-caliper"), "one-caliper", None, ""),
        (WrittenValue(""), "", None, ""),
        (WrittenValue("0.1 .. 0.2"), "0.1 .. 0.2", 0.1, ".. 0.2"),
    ],
)
def test_a_written_value_keeps_its_number_and_is_its_text_in_json(value, text, number, unit):
    assert ADAPTER.dump_python(value, mode="json") == text
    assert ADAPTER.validate_python(text) == value
    assert (value.label, value.number, value.unit) == (text, pytest.approx(number), unit)


@pytest.mark.parametrize(
    ("interval", "label", "middle"),
    [
        (DrawnInterval(60.0, 70.0, "%"), "60 .. 70 %", 65.0),
        (DrawnInterval(2.19e-8, 2.38e-8, "m3/s"), "2.19e-08 .. 2.38e-08 m3/s", 2.285e-8),
        (DrawnInterval(-0.5, 0.0, ""), "-0.5 .. 0", -0.25),
    ],
)
def test_an_interval_is_its_ends_in_json(interval, label, middle):
    form = {"low": interval.low, "high": interval.high, "unit": interval.unit}
    assert ADAPTER.dump_python(interval, mode="json") == form
    assert ADAPTER.validate_python(form) == interval
    assert (interval.label, interval.number) == (label, pytest.approx(middle))


@pytest.mark.parametrize(
    "other", [None, 3, ["a"], {"low": 1.0, "unit": "m"}, {"low": "a", "high": 2, "unit": ""}]
)
def test_what_is_neither_text_nor_interval_is_no_value(other):
    with pytest.raises(ValueError, match="validation error"):
        ADAPTER.validate_python(other)


@pytest.mark.parametrize(
    ("unit", "numbers", "expected"),
    [
        ("km/h", [0.0, 19.99, 20.0, 50.0], [0, 0, 1, 1]),  # 72 km/h
        ("", [71.9, 72.0], [0, 1]),
        ("degC", [345.14, 345.15], [0, 1]),
    ],
)
def test_a_number_at_a_boundary_lies_in_the_upper_interval(unit, numbers, expected):
    intervals = [DrawnInterval(36.0, 72.0, unit), DrawnInterval(72.0, 108.0, unit)]
    assert interval_indices(intervals, np.array(numbers)).tolist() == expected


def test_neighbouring_values_are_labelled_by_their_ends():
    intervals = [DrawnInterval(0.06, 0.07, "m"), DrawnInterval(0.07, 0.08, "m")]
    assert range_label(intervals) == "0.06 .. 0.08 m"
    assert range_label(intervals[:1]) == "0.06 .. 0.07 m"
    assert range_label([WrittenValue("dry"), WrittenValue("wet")]) == "dry .. wet (2 values)"
    assert range_label([WrittenValue("dry")]) == "dry"
