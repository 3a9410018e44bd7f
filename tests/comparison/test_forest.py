"""The forest of paired differences: order, places and what has no share."""

import math

import pytest

from uictest.analysis.comparison.paired.difference import CONFIDENCE, PairedDifference, PairedGroup
from uictest.analysis.comparison.paired.wording import effects
from uictest.core.series_measures import Estimate
from uictest.report.page import forest


def _difference(quantity, mean, half, first=100.0):
    estimate = Estimate(mean, mean - half, mean + half, CONFIDENCE, "mean", 6, mean, mean, math.nan)
    return PairedDifference(quantity, "m", first, first + mean, estimate, estimate, 6, 0, 0)


def _drawn(*differences):
    group = PairedGroup("stop", (0, 1, 2, 3, 4, 5), 6, 6, (0, 0), differences)
    return forest(effects(group), "effects", "%")


def _across(plot, kind):
    """Return the pixels across at which the shapes of a kind begin."""
    return [float(shape.path[1:].split()[0]) for shape in plot.shapes if shape.kind.startswith(kind)]


def test_the_largest_effect_stands_first_whatever_its_sign():
    drawn = _drawn(_difference("a", 1.0, 0.5), _difference("b", -8.0, 1.0), _difference("c", 3.0, 1.0))
    assert drawn is not None
    assert [name for _, name in drawn.y_ticks] == ["b", "c", "a"]
    heights = [y for y, _ in drawn.y_ticks]
    assert heights == sorted(heights)


def test_places_are_in_proportion_to_the_share_of_the_first_side():
    drawn = _drawn(_difference("a", 4.0, 2.0), _difference("b", 4.0, 2.0, first=200.0))
    assert drawn is not None
    (zero,) = _across(drawn, "zero")
    means = [x + 4.0 - zero for x in _across(drawn, "effect")]  # from the middle of the circles
    lows = [x - zero for x in _across(drawn, "interval-line")]
    assert means == pytest.approx([2 * means[1], means[1]], abs=0.2)
    assert lows == pytest.approx([0.5 * means[0], 0.5 * means[1]], abs=0.2)


def test_a_dot_is_filled_where_the_interval_leaves_out_zero():
    drawn = _drawn(_difference("a", 3.0, 1.0), _difference("b", 2.0, 2.5), _difference("c", -1.0, 0.5))
    assert drawn is not None
    filled = [shape.words[0] for shape in drawn.shapes if shape.kind == "effect clear"]
    assert filled == ["a", "c"]


def test_a_mean_beyond_the_axis_is_written_out():
    drawn = _drawn(_difference("a", 900.0, 1.0), _difference("b", 3.0, 1.0))
    assert drawn is not None
    assert drawn.y_ticks[0][1] == "a, +900 %"


def test_what_has_no_share_or_no_interval_is_left_to_the_table():
    without = _difference("c", 1.0, math.nan)
    assert _drawn(_difference("a", 1.0, 0.5, first=0.0), without) is None
