import math

import pytest
from hypothesis import assume, given, strategies as st

from studies.quantity import (
    WIDTH,
    OwnBand,
    PaperComparison,
    SourceBand,
    StudyQuantity,
    StudyValue,
    band_plot,
    spread,
)


def quantity(band):
    return StudyQuantity("error", "error", status="predicted", band=band)


@pytest.mark.parametrize(
    ("value", "status"),
    [(0.45, "holds"), (0.55, "holds"), (0.4499, "misses"), (0.5501, "misses"), (math.nan, "misses")],
)
def test_both_ends_of_a_band_belong_to_it(value, status):
    assert quantity(OwnBand(lower=0.45, upper=0.55, reason="ours")).result(value) == status


def test_what_must_stay_below_a_bound_may_not_reach_it():
    assert not SourceBand(upper=2.0, below=True).contains(2.0)
    assert SourceBand(upper=2.0).contains(2.0)


@given(st.floats())
def test_without_a_band_a_figure_is_only_shown(value):
    assert quantity(None).result(value) == "shown"


@pytest.mark.parametrize(
    ("band", "value", "fails"),
    [
        (OwnBand(upper=2.0, reason="ours"), 1.0, False),
        (OwnBand(upper=2.0, reason="ours"), 3.0, True),
        (SourceBand(upper=2.0), 3.0, True),
        (SourceBand(upper=2.0, declared_miss="heat"), 3.0, False),
        (SourceBand(upper=2.0, declared_miss="heat"), 1.0, True),
        (SourceBand(upper=2.0, declared_miss="heat"), math.nan, True),
        (None, 3.0, False),
    ],
)
def test_a_study_fails_by_what_is_not_as_claimed(band, value, fails):
    """A miss that nobody declared, and a declaration that is not true."""
    assert PaperComparison(quantity(band), StudyValue(value)).fails is fails


def test_a_band_of_ours_cannot_be_declared_missed_and_every_quantity_says_what_it_is_worth():
    fields = {"upper": 2.0, "reason": "ours", "declared_miss": "heat"}
    assert SourceBand(**fields).declared_miss == "heat"
    with pytest.raises(TypeError, match="declared_miss"):
        OwnBand(**fields)
    with pytest.raises(TypeError, match="status"):
        StudyQuantity(key="force", title="force")


@given(st.lists(st.floats(-1e9, 1e9), min_size=1))
def test_a_median_lies_within_its_range(values):
    found = spread(values)
    assert (found.low, found.high) == (min(values), max(values))
    assert found.low <= found.value <= found.high


@pytest.mark.parametrize("values", [[], [1.0, math.nan, 2.0]])
def test_without_a_figure_of_every_repeat_there_is_no_median(values):
    assert math.isnan(spread(values).value)


numbers = st.floats(-1e6, 1e6)


def plot_of(lower, upper, *value):
    band = None if lower is None and upper is None else OwnBand(lower=lower, upper=upper, reason="ours")
    return band_plot(PaperComparison(quantity(band), StudyValue(*value)))


@given(lower=numbers, width=st.floats(1e-3, 1e6), value=numbers)
def test_a_value_is_drawn_in_the_band_where_it_holds_and_beside_it_where_not(lower, width, value):
    upper = lower + width
    assume(upper > lower)
    plot = plot_of(lower, upper, value)
    left, right = plot.band
    assert 0.0 <= left <= right <= WIDTH
    assert 0.0 <= plot.value <= WIDTH
    # Pixels are rounded: at the edge a value may fall on it.
    assert plot.holds == (lower <= value <= upper)
    assert (left <= plot.value <= right) or not plot.holds


def test_a_band_with_one_limit_reaches_the_edge():
    below = plot_of(None, 2.0, 1.0, 0.5, 1.5)
    above = plot_of(2.0, None, 1.0)
    assert (below.band[0], above.band[1]) == (0.0, WIDTH)
    assert below.low < below.value < below.high
    assert above.value < above.band[0]
    assert (below.holds, above.holds) == (True, False)


@pytest.mark.parametrize(
    ("lower", "upper", "value"), [(None, None, 1.0), (1.0, None, float("nan")), (None, 1.0, float("inf"))]
)
def test_nothing_is_drawn_without_a_band_or_a_value(lower, upper, value):
    assert plot_of(lower, upper, value) is None
