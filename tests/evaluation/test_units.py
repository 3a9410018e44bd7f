import pytest

from uictest.evaluation.units import in_unit, normal_volume, text, tidy


def test_one_normal_litre_of_air_weighs_1_185_g() -> None:
    assert in_unit(normal_volume(1.185e-3), "NL") == pytest.approx(1.0)


def test_a_bound_comes_back_as_it_was_written() -> None:
    assert tidy(in_unit(0.08 * 9.80665, "g")) == 0.08
    assert tidy(in_unit(120 / 3.6, "km/h")) == 120.0


@pytest.mark.parametrize(
    ("value", "unit", "shown"),
    [
        (0.0712, "g", "0.0712 g"),
        (465.0, "m", "465 m"),
        (12345.6, "m", "12346 m"),
        (1e-9, "1", "1e-09"),
        (11.0, "1", "11"),
    ],
)
def test_values_are_printed_to_four_digits_with_their_unit(value: float, unit: str, shown: str) -> None:
    assert text(value, unit) == shown
