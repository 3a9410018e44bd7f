import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.report.page.axis import Axis, round_step, span


@given(st.floats(1e-9, 1e9))
def test_a_step_is_round_and_not_below_what_was_asked(step):
    found = round_step(step)
    assert step * (1 - 1e-6) <= found <= 2.5 * step * (1 + 1e-6)
    assert f"{found:.0e}"[0] in "125"


@given(st.floats(-1e6, 1e6), st.floats(1e-3, 1e6), st.integers(2, 12))
def test_ticks_lie_on_the_axis_and_are_few(low, extent, most):
    axis = Axis(low, low + extent, 0.0, 100.0)
    ticks = axis.ticks(most)
    assert len(ticks) <= most + 1
    assert all(low - 1e-6 * extent <= at <= low + extent * (1 + 1e-6) for at, _ in ticks)


def test_labels_have_the_decimals_of_the_step_and_what_lies_outside_is_drawn_at_the_edge():
    labels = [label for _, label in Axis(0.0, 0.1, 0.0, 1.0).ticks(5)]
    assert labels == ["0.00", "0.02", "0.04", "0.06", "0.08", "0.10"]
    axis = Axis(0.0, 10.0, 100.0, 0.0)
    assert (axis.at(-5.0), axis.at(2.5), axis.at(99.0)) == (100.0, 75.0, 0.0)


@pytest.mark.parametrize(
    ("values", "include", "expected"),
    [
        ([], [], (0.0, 1.04)),
        ([np.nan], [0.0], (0.0, 1.0)),
        ([3.0, 3.0], [], (3.0, 4.0)),
        ([0.0, 10.0], [0.0], (0.0, 10.4)),
        ([-10.0, 0.0, np.inf], [], (-10.4, 0.4)),
    ],
)
def test_the_span_holds_everything_finite(values, include, expected):
    assert span([np.array(values)], include) == pytest.approx(expected)
