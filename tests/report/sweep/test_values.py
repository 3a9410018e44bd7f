import pytest
from pydantic import TypeAdapter

from uictest.report import DrawnInterval, SweptValue, WrittenValue
from uictest.report.sweep.values import range_label

ADAPTER = TypeAdapter(SweptValue)


@pytest.mark.parametrize(
    ("value", "text", "number", "unit"),
    [
        (WrittenValue("80 km/h"), "80 km/h", 80.0, "km/h"),
        (WrittenValue("0.12"), "0.12", 0.12, ""),
        (WrittenValue("one-caliper"), "one-caliper", None, ""),
        (WrittenValue(""), "", None, ""),
        (WrittenValue("from here .. to there"), "from here .. to there", None, "here .. to there"),
        (DrawnInterval(60.0, 70.0, "%"), "60 .. 70 %", 65.0, "%"),
        (DrawnInterval(2.19e-8, 2.38e-8, "m3/s"), "2.19e-08 .. 2.38e-08 m3/s", 2.285e-8, "m3/s"),
        (DrawnInterval(-0.5, 0.0, ""), "-0.5 .. 0", -0.25, ""),
    ],
)
def test_a_value_keeps_its_numbers_and_goes_to_json_and_back(value, text, number, unit):
    assert ADAPTER.dump_python(value, mode="json") == text
    assert ADAPTER.validate_python(text) == value
    assert (value.label, value.number, value.unit) == (text, pytest.approx(number), unit)


@pytest.mark.parametrize("other", [None, 3, ["a"]])
def test_what_is_no_text_is_no_value(other):
    with pytest.raises(ValueError, match="text of a value"):
        ADAPTER.validate_python(other)


def test_neighbouring_values_are_labelled_by_their_ends():
    intervals = [DrawnInterval(0.06, 0.07, "m"), DrawnInterval(0.07, 0.08, "m")]
    assert range_label(intervals) == "0.06 .. 0.08 m"
    assert range_label(intervals[:1]) == "0.06 .. 0.07 m"
    assert range_label([WrittenValue("dry"), WrittenValue("wet")]) == "dry .. wet (2 values)"
    assert range_label([WrittenValue("dry")]) == "dry"
