"""Pressure demand of the brake command and the relay valve that follows it."""

import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.valves import demanded_pressure, relay_opening

FULL = 3.8e5
FILLING_RATE = 1.0 / 1.5
GAIN = 1.0 / 2e4
times = st.floats(0.0, 100.0)


@given(times, times)
def test_demand_never_falls_and_never_exceeds_the_command(a, b):
    early, late = sorted((a, b))
    assert (
        0.0
        <= demanded_pressure(early, 0.0, FULL, 0.4, FILLING_RATE)
        <= demanded_pressure(late, 0.0, FULL, 0.4, FILLING_RATE)
        <= FULL
    )


@pytest.mark.parametrize(("time", "share"), [(0.0, 0.0), (0.4, 0.0), (1.15, 0.5), (1.9, 1.0), (60.0, 1.0)])
def test_demand_waits_for_the_dead_time_and_rises_evenly(time, share):
    assert demanded_pressure(time, 0.0, FULL, 0.4, FILLING_RATE) == pytest.approx(share * FULL, abs=1e-6)


def test_relay_valve_laps_at_the_demand():
    assert relay_opening(FULL, FULL, GAIN) == 0.0


@given(st.floats(0.0, 1e6), st.floats(0.0, 1e6))
def test_relay_valve_fills_towards_a_higher_demand_and_exhausts_towards_a_lower(d, p):
    opening = relay_opening(d, p, GAIN)
    assert -1.0 <= opening <= 1.0
    assert opening * (d - p) >= 0.0
    if abs(d - p) >= 2e4:
        assert abs(opening) == 1.0
