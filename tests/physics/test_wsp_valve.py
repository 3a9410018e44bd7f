"""WSP valve: the register of commands and the travel of its armatures."""

import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.valves import (
    FILL,
    HOLD,
    LONGEST_DELAY_CYCLES,
    VENT,
    command_before,
    remember,
    travel,
)

commands = st.lists(st.sampled_from([FILL, HOLD, VENT]), min_size=1, max_size=80)


@given(commands, st.integers(0, LONGEST_DELAY_CYCLES + 1))
def test_register_remembers_every_command_that_a_delay_can_ask_for(given_, cycles):
    register = 0
    for command in given_:
        register = remember(register, command)
    history = [FILL] * (LONGEST_DELAY_CYCLES + 2) + given_
    assert command_before(register, cycles) == history[-1 - cycles]


@given(commands)
def test_register_fits_the_signed_integer_of_a_record(given_):
    register = 0
    for command in given_:
        register = remember(register, command)
    assert 0 <= register << 2 < 1 << 63


@pytest.mark.parametrize("steps", [1, 7, 40])
def test_travel_takes_its_time_and_ends_at_the_stop(steps):
    opening = 0.0
    for _ in range(steps):
        assert opening < 1.0
        opening = travel(opening, 1.0, 1.0 / steps)
    assert opening == pytest.approx(1.0, abs=1e-12)
    assert travel(opening, 1.0, 1.0 / steps) == 1.0


def test_travel_turns_back_from_where_it_is():
    assert travel(0.4, 0.0, 0.1) == pytest.approx(0.3)
