"""Sobol' indices as bars: each index and its interval lie where the axis says."""

import math

import pytest

from uictest.report import SobolIndex, SobolSensitivity, WrittenValue
from uictest.report.page.sweep.sobol_bars import sobol_plots


def sensitivity(measure, key, first, total, at=""):
    return SobolSensitivity(measure, {"seed": WrittenValue(at)} if at else {}, key, first, total)


def value_at(plot, pixel):
    """Return what the labels of the axis say of a pixel."""
    (x0, first), *_, (x1, last) = plot.ticks
    return float(first) + (pixel - x0) / (x1 - x0) * (float(last) - float(first))


def test_bars_and_intervals_lie_at_their_numbers():
    first, total = SobolIndex(0.3, 0.1, 0.45), SobolIndex(0.6, 0.5, 0.8)
    small = SobolIndex(-0.05, -0.1, 0.02)
    (plot,) = sobol_plots(
        [sensitivity("met", "friction", first, total), sensitivity("met", "mass", small, small)]
    )
    assert plot.title == "cases met"
    assert [name for _, name in plot.names] == ["friction", "mass"]
    for bar, index in zip(plot.bars, (first, total, small, small), strict=True):
        ends = sorted((0.0, index.value))
        found = [value_at(plot, at) for at in (bar.x, bar.x + bar.width, bar.low, bar.high)]
        assert found == pytest.approx([*ends, index.low, index.high], abs=1e-9)
        assert not (bar.low_is_cut_off or bar.high_is_cut_off)
    assert plot.bars[0].label == "alone: 0.30, 95 % confidence 0.10 to 0.45"
    assert value_at(plot, plot.zero) == pytest.approx(0.0, abs=1e-9)


def test_an_interval_that_leaves_the_axis_is_marked():
    (plot,) = sobol_plots([sensitivity("met", "a", SobolIndex(0.7, -3.0, 1.0), SobolIndex(1.0, 0.0, 3.1))])
    assert [(bar.low_is_cut_off, bar.high_is_cut_off) for bar in plot.bars] == [(True, False), (False, True)]
    assert value_at(plot, plot.bars[1].high) == pytest.approx(2.0)


def test_each_measure_and_each_listed_value_has_its_own_drawing():
    index = SobolIndex(0.5, 0.4, 0.6)
    plots = sobol_plots(
        [
            sensitivity(measure, key, index, index, seed)
            for measure in ("braking_distance_m", "met")
            for seed in ("1", "2")
            for key in ("a", "b")
        ]
    )
    titles = [f"{name}, at seed = {n}" for name in ("braking distance, m", "cases met") for n in (1, 2)]
    assert [(plot.title, len(plot.bars)) for plot in plots] == [(title, 4) for title in titles]


def test_an_index_that_does_not_exist_has_no_bar():
    nothing = SobolIndex(math.nan, math.nan, math.nan)
    (plot,) = sobol_plots([sensitivity("met", "a", nothing, SobolIndex(0.5, 0.4, 0.6))])
    assert (plot.bars[0].width, plot.bars[0].high - plot.bars[0].low) == (0.0, 0.0)
