"""Linear and logarithmic axes."""

import pytest
from hypothesis import given, strategies as st

from uictest.report.page.sweep.cell_axis import NumberAxis, spanned


def test_equal_ratios_are_equally_long():
    axis = NumberAxis(0.1, 1000.0, 0.0, 400.0, logarithmic=True)
    places = [axis.at(value) for value in (0.1, 1.0, 10.0, 100.0, 1000.0)]
    assert places == pytest.approx([0, 100, 200, 300, 400])
    assert [label for _, label in axis.tick_marks(6)] == ["0.1", "1", "10", "100", "1000"]


@pytest.mark.parametrize(
    ("low", "high", "logarithmic", "most", "labels"),
    [
        # Decades have ones, twos and fives where there is room; less than a decade has even steps.
        (8e-9, 6e-7, True, 8, "1e-08 2e-08 5e-08 1e-07 2e-07 5e-07"),
        (2e-8, 3.9e-8, True, 5, "2e-08 2.5e-08 3e-08 3.5e-08"),
        (32000.0, 32010.0, False, 7, "32000 32002 32004 32006 32008 32010"),
    ],
)
def test_ticks_are_round_and_have_labels_of_their_own(low, high, logarithmic, most, labels):
    axis = NumberAxis(low, high, 0.0, 100.0, logarithmic=logarithmic)
    assert " ".join(label for _, label in axis.tick_marks(most)) == labels


@given(st.floats(1e-9, 1e9), st.floats(1.01, 1e12), st.booleans())
def test_ticks_lie_on_the_axis_where_their_numbers_do(low, ratio, logarithmic):
    axis = NumberAxis(low, low * ratio, 0.0, 100.0, logarithmic)
    ticks = axis.tick_marks(7)
    assert 1 <= len(ticks) <= 9
    assert [at for at, _ in ticks] == sorted(at for at, _ in ticks)
    for at, label in ticks:
        assert at == pytest.approx(axis.at(float(label)), abs=0.5)


def test_an_axis_with_a_number_that_has_no_logarithm_is_linear():
    assert not spanned([0.0, 1.0], 0.0, 1.0, logarithmic=True).logarithmic
    axis = spanned([1.0, 100.0], 0.0, 1.0, logarithmic=True)
    assert axis.logarithmic
    assert 0.0 < axis.at(1.0) < 0.1
