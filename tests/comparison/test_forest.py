"""The forest of paired differences: order, places and what has no share."""

from __future__ import annotations

import math

import pytest

from uictest.analysis.comparison.paired.difference import CONFIDENCE, PairedDifference, PairedGroup
from uictest.analysis.comparison.paired.wording import effects
from uictest.core.series_measures import Estimate
from uictest.report.page import Forest, forest


def _difference(quantity: str, mean: float, half: float, first: float = 100.0) -> PairedDifference:
    estimate = Estimate(mean, mean - half, mean + half, CONFIDENCE, "mean", 6, mean, mean, math.nan)
    return PairedDifference(quantity, "m", first, first + mean, estimate, estimate, 6, 0, 0)


def _drawn(*differences: PairedDifference) -> Forest | None:
    return forest(effects(PairedGroup("stop", (0, 1, 2, 3, 4, 5), 6, 6, (0, 0), differences)))


def test_the_largest_effect_stands_first_whatever_its_sign() -> None:
    drawn = _drawn(_difference("a", 1.0, 0.5), _difference("b", -8.0, 1.0), _difference("c", 3.0, 1.0))
    assert drawn is not None
    assert [row.name for row in drawn.rows] == ["b", "c", "a"]
    assert [row.y for row in drawn.rows] == sorted(row.y for row in drawn.rows)


def test_places_are_in_proportion_to_the_share_of_the_first_side() -> None:
    drawn = _drawn(_difference("a", 4.0, 2.0), _difference("b", 4.0, 2.0, first=200.0))
    assert drawn is not None
    of_a, of_b = ([x - drawn.zero for x in (row.low, row.mean, row.high)] for row in drawn.rows)
    assert of_a == pytest.approx([2 * x for x in of_b])
    assert of_a[0] / of_a[1] == pytest.approx(0.5)


def test_a_dot_is_filled_where_the_interval_leaves_out_zero() -> None:
    drawn = _drawn(_difference("a", 3.0, 1.0), _difference("b", 2.0, 2.5), _difference("c", -1.0, 0.5))
    assert drawn is not None
    assert {row.name: row.clear for row in drawn.rows} == {"a": True, "b": False, "c": True}


def test_a_mean_beyond_the_axis_is_written_out() -> None:
    drawn = _drawn(_difference("a", 900.0, 1.0), _difference("b", 3.0, 1.0))
    assert drawn is not None
    assert drawn.rows[0].name == "a, +900 %"
    assert drawn.rows[0].mean > drawn.rows[1].mean


def test_what_has_no_share_or_no_interval_is_left_to_the_table() -> None:
    without = _difference("c", 1.0, math.nan)
    assert _drawn(_difference("a", 1.0, 0.5, first=0.0), without) is None
