"""Histograms of a sweep: every case in one bin, whatever the chunks."""

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given, strategies as st

from uictest.analysis.summaries.histograms import HistogramCounts, ReportedMeasure, reported_measures

MEASURE = ReportedMeasure("slide", "%", ("a", "b"), 100.0)
values = st.one_of(st.none(), st.floats(-1e6, 1e6))
rows = st.lists(
    st.tuples(values, values, st.sampled_from(["pass", "fail", "error"])), min_size=1, max_size=60
)


def table(found):
    a, b, outcome = ([row[place] for row in found] for place in range(3))
    numbers = {"a": pa.array(a, pa.float64()), "b": pa.array(b, pa.float64())}
    return pa.table({**numbers, "outcome": pa.array(outcome, pa.string())})


def distribution(*chunks):
    counts = HistogramCounts(MEASURE)
    for chunk in chunks:
        counts.add_range(chunk)
    if counts.cases:
        counts.open_bins()
        for chunk in chunks:
            counts.add(chunk)
    return counts


@given(rows, st.integers(0, 60))
def test_every_case_with_the_figure_is_counted_once_in_any_parts(found, cut):
    histogram = distribution(table(found[:cut]), table(found[cut:]))
    known = [
        (100.0 * max(x for x in (a, b) if x is not None), o) for a, b, o in found if (a, b) != (None, None)
    ]
    assert histogram.cases == len(known)
    if known:
        result = histogram.histogram()
        assert sum(map(sum, result.counts.values())) == len(known)
        for outcome, counts in result.counts.items():
            own = [value for value, each in known if each == outcome]
            np.testing.assert_array_equal(counts, np.histogram(own, result.edges)[0])
        assert (result.minimum, result.maximum) == (min(known)[0], max(known)[0])
        assert result.mean == pytest.approx(np.mean([value for value, _ in known]), rel=1e-9, abs=1e-6)


def test_a_count_has_a_bin_for_each_whole_number_and_one_value_a_span():
    result = distribution(table([(k / 100.0, None, "pass") for k in (2, 5, 5)])).histogram()
    assert result.edges == [1.5, 2.5, 3.5, 4.5, 5.5]
    assert result.counts == {"pass": [1, 0, 0, 2]}
    result = distribution(table([(0.123, None, "pass")])).histogram()
    assert result.edges[0] < 12.3 < result.edges[-1]
    names = [
        measure.name for measure in reported_measures(["braking_distance_m", "locked_time_s_3"], "10 km/h")
    ]
    assert names.count("braking distance") == 1
    assert names[-1] == "locked_time_s_3"
