import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.report.page.plot import Axis, round_step, span, spanned


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


def test_equal_ratios_are_equally_long_on_a_logarithmic_axis():
    axis = Axis(0.1, 1000.0, 0.0, 400.0, logarithmic=True)
    places = [axis.at(value) for value in (0.1, 1.0, 10.0, 100.0, 1000.0)]
    assert places == pytest.approx([0, 100, 200, 300, 400])
    assert axis.pixels(np.array([0.1, 10.0, np.nan])).tolist() == pytest.approx([0, 200, np.nan], nan_ok=True)
    assert [label for _, label in axis.tick_marks(6)] == ["0.1", "1", "10", "100", "1000"]


@pytest.mark.parametrize(
    ("low", "high", "logarithmic", "most", "labels"),
    [
        # Decades have ones, twos and fives where there is room; less than a decade has even steps.
        (8e-9, 6e-7, True, 8, "1e-08 2e-08 5e-08 1e-07 2e-07 5e-07"),
        (2e-8, 3.9e-8, True, 5, "2e-08 2.5e-08 3e-08 3.5e-08"),
        (32000.0, 32010.0, False, 7, "32000 32002 32004 32006 32008 32010"),
        (1.0, 4294967295.0, False, 4, "0 2000000000 4000000000"),
    ],
)
def test_ticks_are_round_and_have_labels_of_their_own(low, high, logarithmic, most, labels):
    axis = Axis(low, high, 0.0, 100.0, logarithmic=logarithmic)
    found = [label for _, label in axis.tick_marks(most)]
    assert found == labels.split()


@given(st.floats(1e-9, 1e9), st.floats(1.01, 1e12), st.booleans())
def test_ticks_lie_on_the_axis_where_their_numbers_do(low, ratio, logarithmic):
    axis = Axis(low, low * ratio, 0.0, 100.0, logarithmic)
    ticks = axis.tick_marks(7)
    assert 1 <= len(ticks) <= 9
    assert [at for at, _ in ticks] == sorted(at for at, _ in ticks)
    for at, label in ticks:
        assert at == pytest.approx(axis.at(float(label)), abs=0.5)


def test_an_axis_with_a_number_that_has_no_logarithm_is_linear():
    assert not spanned([0.0, 1.0], 0.0, 1.0, logarithmic=True).logarithmic
    axis = spanned([1.0, 100.0, float("nan")], 0.0, 1.0, logarithmic=True)
    assert axis.logarithmic
    assert 0.0 < axis.at(1.0) < 0.1
