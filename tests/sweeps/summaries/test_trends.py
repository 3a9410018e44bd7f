"""Trends of a sweep: the same cases at every value."""

import numpy as np
import pyarrow as pa

from uictest.analysis.summaries.reported_measures import ReportedMeasure
from uictest.analysis.summaries.tally import bins_of_plan
from uictest.analysis.summaries.trends import TrendSums

from ..conftest import MATRIX

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


def test_a_value_at_which_no_case_has_the_measure_takes_no_other_away(load):
    plan = load(MATRIX)
    adhesion = np.array([np.nan, np.nan, 0.07, 0.08, 0.09, 0.10])
    rows = pa.table({"index": np.arange(6), "adhesion": adhesion})
    sums = TrendSums(plan, bins_of_plan(plan)[plan.groups[0].keys[0]], [MEASURE])
    sums.note(rows)
    sums.add(rows)
    (trend,) = sums.trends()
    assert trend.cases == [0, 2, 2]
    assert trend.mean[0] is None
