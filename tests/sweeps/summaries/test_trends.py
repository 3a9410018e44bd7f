"""Counts and trends along parameters."""

from itertools import pairwise

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given, strategies as st

from uictest.analysis.summaries.tally import bins_of_plan, logarithmic_keys, spaced_logarithmically
from uictest.analysis.summaries.trends import ReportedMeasure, TrendSums
from uictest.report import DrawnInterval

from ..conftest import MATRIX

TEXT = """\
matrix:
  seed: [1, 10, 100]
  rail.gradient: [1 permille, 2 permille, 3 permille, 4 permille]
sample:
  size: 8
  parameters:
    rail.friction: {uniform: [0.01, 0.15]}
    brake.system.wsp_valve.vent_conductance: {log-uniform: [1e-8 m3/(s Pa), 4e-8 m3/(s Pa)]}
"""


def test_drawn_and_listed_parameters_of_one_unit_are_logarithmic_in_intervals_of_like_ratios(load):
    assert logarithmic_keys(load(TEXT)) == ("seed", "brake.system.wsp_valve.vent_conductance")
    assert not spaced_logarithmically(["1 m/s", "10 m/s", "100 km/h"])
    values = bins_of_plan(load(TEXT))["brake.system.wsp_valve.vent_conductance"].values
    edges = [value.low for value in values if isinstance(value, DrawnInterval)]
    assert len(edges) == 10
    assert edges[0] == 1e-8
    for before, after in pairwise(edges):
        assert after / before == pytest.approx(4.0**0.1, rel=0.01)
    assert values[5].label == "2e-08 .. 2.3e-08 m3/(s Pa)"


@pytest.mark.parametrize(
    "texts", ["1 2 5 10 20 50", "0.01 0.1 1", "8 4 2 1", "0.5e-8 1e-8 2e-8 4e-8", "10 20 50 100", "1 3 10"]
)
def test_like_ratios_are_logarithmic(texts):
    assert spaced_logarithmically([f"{text} km/h" for text in texts.split()])


EVEN = ["60 80 100 120", "60 80 120 160", "0 1 10", "-1 -10 -100", "1 100", "1 10 5", "1 4 16 4.5"]


@pytest.mark.parametrize("texts", [*EVEN, "one two three", "1 1 1"])
def test_others_are_not(texts):
    assert not spaced_logarithmically(texts.split())


@given(st.floats(0.001, 1e3), st.floats(2.0, 20.0), st.integers(3, 8))
def test_a_geometric_sequence_is_and_an_arithmetic_one_is_not(first, factor, count):
    assert spaced_logarithmically([repr(first * factor**k) for k in range(count)])
    assert not spaced_logarithmically([repr(first + factor * k) for k in range(1, count + 1)])


MEASURE = ReportedMeasure("initial adhesion", "g", ("adhesion",))


def test_a_mean_is_that_of_the_combinations_that_have_the_measure_at_every_value(load):
    plan = load(MATRIX)
    first, second = plan.groups
    assert (first.size, second.size) == (3, 2)
    # The measure depends on the first parameter alone; at the first value of the second it is missing twice.
    adhesion = np.repeat([0.05, 0.07, 0.09], 2)
    adhesion[[0, 2]] = np.nan
    rows = pa.table({"index": np.arange(6), "adhesion": adhesion})
    chunks = [rows.slice(0, 3), rows.slice(3)]
    trends = {}
    for bins in bins_of_plan(plan).values():
        sums = TrendSums(plan, bins, [MEASURE])
        for chunk in chunks:
            sums.note(chunk)
        for chunk in chunks:
            sums.add(chunk)
        (trends[bins.key],) = sums.trends()
    over_first, over_second = (trends[group.keys[0]] for group in (first, second))
    assert (over_first.cases, over_first.mean) == ([1, 1, 1], [0.05, 0.07, 0.09])
    assert (over_second.cases, over_second.mean) == ([1, 1], [0.09, 0.09])
    # A value at which no case has the measure takes no other away.
    rows = pa.table({"index": np.arange(6), "adhesion": [np.nan, np.nan, 0.07, 0.08, 0.09, 0.10]})
    sums = TrendSums(plan, bins_of_plan(plan)[first.keys[0]], [MEASURE])
    sums.note(rows)
    sums.add(rows)
    (trend,) = sums.trends()
    assert (trend.cases, trend.mean[0]) == ([0, 2, 2], None)
