"""Reservoir and compressor."""

import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.air import compressor_running, isothermal_pressure


def test_air_at_the_standard_state_weighs_what_tables_say():
    """Dry air at 1.01325 bar and 15 degC: 1.225 kg/m3 (ISO 2533)."""
    assert isothermal_pressure(1.225, 287.05 * 288.15) == pytest.approx(101_325.0, rel=1e-4)


def test_compressor_starts_below_cut_in_and_stops_above_cut_out():
    running = 0.0
    states = []
    for pressure in (8.0, 7.5, 6.9, 7.5, 8.0, 8.1, 7.5, 6.9):
        running = compressor_running(pressure, running, cut_in=7.0, cut_out=8.0)
        states.append(running)
    assert states == [0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0]


@given(st.floats(7.0, 8.0), st.sampled_from([0.0, 1.0]))
def test_compressor_keeps_its_state_between_the_two_pressures(pressure, running):
    assert compressor_running(pressure, running, 7.0, 8.0) == running
