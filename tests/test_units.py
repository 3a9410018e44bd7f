import pytest

from uictest.core.physics import REFERENCE_DENSITY
from uictest.core.units import (
    KINDS,
    SIZES,
    as_written,
    in_unit,
    normal_volume,
    recorded_unit_size,
    value_text,
)


def test_normal_litres_are_of_the_density_of_iso_8778():
    assert in_unit(normal_volume(1.185e-3), "NL") == pytest.approx(1.0)
    assert float(KINDS["mass flow"].units["NL/min"].factor) == pytest.approx(REFERENCE_DENSITY / 60e3)


def test_a_bound_comes_back_as_it_was_written():
    assert as_written(0.08 * 9.80665, "g") == 0.08
    assert as_written(120 / 3.6, "km/h") == 120.0


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
def test_values_are_printed_to_four_digits_with_their_unit(value, unit, shown):
    assert value_text(value, unit) == shown


@pytest.mark.parametrize(
    ("unit", "si", "size"),
    [("km/h", "m/s", 1 / 3.6), ("KM/H", "m/s", 1 / 3.6), ("mbar", "Pa", 100.0), ("kNm", "N m", 1000.0)],
)
def test_a_recording_may_write_a_unit_as_people_do(unit, si, size):
    assert recorded_unit_size(unit, si) == pytest.approx(size)


def test_degrees_celsius_have_their_own_zero():
    """What only multiplies, as the unit of a recorded channel does, cannot take them."""
    assert in_unit(373.15, "degC") == pytest.approx(100.0)
    assert in_unit(373.15, "K") == 373.15
    assert recorded_unit_size("K", "K") == 1.0
    assert recorded_unit_size("degC", "K") is None


def test_a_unit_of_another_kind_an_ambiguous_one_or_one_of_recordings_alone_is_no_unit_of_scenarios():
    assert recorded_unit_size("bar", "m/s") is None
    assert recorded_unit_size("mPa", "Pa") is None
    assert recorded_unit_size("mbar", "Pa") == 100.0
    assert "mbar" not in KINDS["pressure"].units
    assert "torque" not in KINDS


def test_a_symbol_has_one_size_whatever_it_measures():
    for kind in KINDS.values():
        for unit in kind.units.values():
            assert unit.offset or SIZES[unit.symbol] == float(unit.factor)
