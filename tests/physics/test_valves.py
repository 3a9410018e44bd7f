"""Pressure demand and relay valve; the register of commands of the WSP valve and its travel."""

import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.air import (
    FILL,
    HOLD,
    LONGEST_DELAY_CYCLES,
    VENT,
    command_before,
    demanded_pressure,
    relay_opening,
    remember,
    travel,
)

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


@given(st.floats(0.0, 1e6), st.floats(0.0, 1e6))
def test_relay_valve_fills_towards_a_higher_demand_exhausts_towards_a_lower_and_laps_at_it(d, p):
    opening = relay_opening(d, p, GAIN)
    assert -1.0 <= opening <= 1.0
    assert opening * (d - p) >= 0.0
    assert relay_opening(d, d, GAIN) == 0.0
    if abs(d - p) >= 2e4:
        assert abs(opening) == 1.0


commands = st.lists(st.sampled_from([FILL, HOLD, VENT]), min_size=1, max_size=80)


@given(commands, st.integers(0, LONGEST_DELAY_CYCLES + 1))
def test_register_remembers_every_command_that_a_delay_can_ask_for(given_, cycles):
    register = 0
    for command in given_:
        register = remember(register, command)
    history = [FILL] * (LONGEST_DELAY_CYCLES + 2) + given_
    assert command_before(register, cycles) == history[-1 - cycles]
    assert 0 <= register << 2 < 1 << 63  # the signed integer of a record


@pytest.mark.parametrize("steps", [1, 7, 40])
def test_travel_takes_its_time_ends_at_the_stop_and_turns_back_from_where_it_is(steps):
    opening = 0.0
    for _ in range(steps):
        assert opening < 1.0
        opening = travel(opening, 1.0, 1.0 / steps)
    assert opening == pytest.approx(1.0, abs=1e-12)
    assert travel(opening, 1.0, 1.0 / steps) == 1.0
    assert travel(0.4, 0.0, 0.1) == pytest.approx(0.3)
