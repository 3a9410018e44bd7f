import math

import pytest
from hypothesis import assume, given, strategies as st

from uictest.judging.evaluation.bounds import Bounds, deciding

any_number = st.floats(allow_nan=True, allow_infinity=True)
number = st.floats(-1e9, 1e9)


@st.composite
def some_bounds(draw):
    lower, upper = draw(st.none() | number), draw(st.none() | number)
    assume(lower is not None or upper is not None)
    assume(lower is None or upper is None or lower <= upper)
    return Bounds(lower, upper, draw(st.booleans()))


@given(some_bounds())
def test_nan_and_infinity_never_hold(bounds):
    assert not any(map(bounds.hold, (math.nan, math.inf, -math.inf)))


@given(some_bounds(), number)
def test_the_margin_is_positive_inside_and_negative_outside(bounds, value):
    margin = bounds.margin(value)
    assert (margin < 0) == (bounds.side(value) != 0)
    assert bounds.hold(value) == (margin > 0 or (margin == 0 and not bounds.strict))


@given(number, st.booleans(), number, number)
def test_more_never_turns_fail_into_pass_under_an_upper_bound(upper, strict, a, b):
    bounds = Bounds(None, upper, strict)
    assert bounds.hold(min(a, b)) or not bounds.hold(max(a, b))


@given(number, st.booleans(), number, number)
def test_less_never_turns_fail_into_pass_over_a_lower_bound(lower, strict, a, b):
    bounds = Bounds(lower, None, strict)
    assert bounds.hold(max(a, b)) or not bounds.hold(min(a, b))


@given(some_bounds(), st.lists(any_number, min_size=1, max_size=4), st.data())
def test_the_deciding_value_holds_if_and_only_if_enough_values_do(bounds, values, data):
    needed = data.draw(st.integers(1, len(values)))
    assert bounds.hold(deciding(values, bounds, needed)) == (sum(map(bounds.hold, values)) >= needed)


@pytest.mark.parametrize(
    ("bounds", "shown"),
    [
        (Bounds(None, 0.08, strict=True), "< 0.08"),
        (Bounds(35.0, None), ">= 35"),
        (Bounds(440.0, 490.0), "440 .. 490"),
    ],
)
def test_bounds_are_printed_as_an_engineer_writes_them(bounds, shown):
    assert str(bounds) == shown
