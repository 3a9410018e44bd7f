from __future__ import annotations

import pytest
from hypothesis import assume, given, strategies as st

from studies.quantity import WIDTH, BandPlot, OwnBand, PaperComparison, StudyQuantity, StudyValue, band_plot

numbers = st.floats(-1e6, 1e6)


def plot_of(lower: float | None, upper: float | None, *value: float) -> BandPlot | None:
    band = None if lower is None and upper is None else OwnBand(lower=lower, upper=upper, reason="ours")
    return band_plot(
        PaperComparison(StudyQuantity("q", "q", status="predicted", band=band), StudyValue(*value))
    )


@given(lower=numbers, width=st.floats(1e-3, 1e6), value=numbers)
def test_a_value_is_drawn_in_the_band_where_it_holds_and_beside_it_where_not(
    lower: float, width: float, value: float
) -> None:
    upper = lower + width
    assume(upper > lower)
    plot = plot_of(lower, upper, value)
    assert plot is not None
    left, right = plot.band
    assert 0.0 <= left <= right <= WIDTH
    assert 0.0 <= plot.value <= WIDTH
    # Pixels are rounded: at the edge a value may fall on it.
    assert plot.holds == (lower <= value <= upper)
    assert (left <= plot.value <= right) or not plot.holds


def test_a_band_with_one_limit_reaches_the_edge() -> None:
    below = plot_of(None, 2.0, 1.0, 0.5, 1.5)
    above = plot_of(2.0, None, 1.0)
    assert below is not None
    assert above is not None
    assert (below.band[0], above.band[1]) == (0.0, WIDTH)
    assert below.low is not None
    assert below.high is not None
    assert below.low < below.value < below.high
    assert above.value < above.band[0]
    assert (below.holds, above.holds) == (True, False)


@pytest.mark.parametrize(
    ("lower", "upper", "value"), [(None, None, 1.0), (1.0, None, float("nan")), (None, 1.0, float("inf"))]
)
def test_nothing_is_drawn_without_a_band_or_a_value(
    lower: float | None, upper: float | None, value: float
) -> None:
    assert plot_of(lower, upper, value) is None
