from __future__ import annotations

import math

import pytest
from hypothesis import given, strategies as st

from uictest.studies.quantity import StudyQuantity, StudyValue, spread


@pytest.mark.parametrize(
    ("value", "status"),
    [(0.45, "holds"), (0.55, "holds"), (0.4499, "misses"), (0.5501, "misses"), (math.nan, "misses")],
)
def test_both_ends_of_a_band_belong_to_it(value: float, status: str) -> None:
    assert StudyQuantity("width", "width", lower=0.45, upper=0.55).status(value) == status


def test_what_must_stay_below_a_bound_may_not_reach_it() -> None:
    assert StudyQuantity("error", "error", upper=2.0, below=True).status(2.0) == "misses"
    assert StudyQuantity("error", "error", upper=2.0).status(2.0) == "holds"


@given(st.floats())
def test_without_a_band_a_figure_is_only_shown(value: float) -> None:
    assert StudyQuantity("force", "force").status(value) == "shown"


@given(st.lists(st.floats(-1e9, 1e9), min_size=1))
def test_a_median_lies_within_its_range(values: list[float]) -> None:
    found = spread(values)
    assert found.low is not None
    assert found.high is not None
    assert (found.low, found.high) == (min(values), max(values))
    assert found.low <= found.value <= found.high


def test_one_repeat_without_a_figure_leaves_no_median() -> None:
    assert math.isnan(spread([1.0, math.nan, 2.0]).value)


def test_a_reading_may_have_no_range() -> None:
    assert StudyValue(1.0).low is None
