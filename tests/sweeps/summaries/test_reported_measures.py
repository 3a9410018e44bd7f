"""Measures that reports show: smallest, mean and largest of the cases that have them, whatever the chunks."""

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given, strategies as st

from uictest.analysis.summaries.reported_measures import MeasureSums, ReportedMeasure, reported_measures

MEASURE = ReportedMeasure("slide", "%", ("a", "b"), 100.0)
values = st.one_of(st.none(), st.floats(-1e6, 1e6))
rows = st.lists(st.tuples(values, values), min_size=1, max_size=60)


def table(found):
    a, b = ([row[place] for row in found] for place in range(2))
    return pa.table({"a": pa.array(a, pa.float64()), "b": pa.array(b, pa.float64())})


@given(rows, st.integers(0, 60))
def test_every_case_with_the_figure_counts_once_in_any_parts(found, cut):
    sums = MeasureSums(MEASURE)
    for chunk in (found[:cut], found[cut:]):
        sums.add(table(chunk))
    known = [100.0 * max(x for x in row if x is not None) for row in found if row != (None, None)]
    assert sums.cases == len(known)
    if known:
        result = sums.range()
        assert (result.minimum, result.maximum) == (min(known), max(known))
        assert result.mean == pytest.approx(np.mean(known), rel=1e-9, abs=1e-6)


def test_a_measure_that_is_asked_for_and_usual_stands_once():
    asked = reported_measures(["braking_distance_m", "locked_time_s_3"], "10 km/h")
    names = [measure.name for measure in asked]
    assert names.count("braking distance") == 1
    assert names[-1] == "locked_time_s_3"
