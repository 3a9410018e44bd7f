"""Histograms of a sweep: every case in one bin, whatever the parts."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given, strategies as st

from uictest.sweep.summaries.histograms import MeasureHistogram, ReportedMeasure, reported_measures

FIGURE = ReportedMeasure("slide", "%", ("a", "b"), 100.0)
values = st.one_of(st.none(), st.floats(-1e6, 1e6))
rows = st.lists(
    st.tuples(values, values, st.sampled_from(["pass", "fail", "error"])), min_size=1, max_size=60
)


def table(found: list[tuple[float | None, float | None, str]]) -> pa.Table:
    a, b, outcome = ([row[place] for row in found] for place in range(3))
    numbers = {"a": pa.array(a, pa.float64()), "b": pa.array(b, pa.float64())}
    return pa.table({**numbers, "outcome": pa.array(outcome, pa.string())})


def distribution(*parts: pa.Table) -> MeasureHistogram:
    made = MeasureHistogram(FIGURE)
    for part in parts:
        made.span(part)
    if made.cases:
        made.begin()
        for part in parts:
            made.take(part)
    return made


@given(rows, st.integers(0, 60))
def test_every_case_with_the_figure_is_counted_once_in_any_parts(
    found: list[tuple[float | None, float | None, str]], cut: int
) -> None:
    made = distribution(table(found[:cut]), table(found[cut:]))
    known = [
        (100.0 * max(x for x in (a, b) if x is not None), o) for a, b, o in found if (a, b) != (None, None)
    ]
    assert made.cases == len(known)
    if known:
        form = made.form()
        assert sum(map(sum, form["counts"].values())) == len(known)
        for outcome, counts in form["counts"].items():
            own = [value for value, each in known if each == outcome]
            np.testing.assert_array_equal(counts, np.histogram(own, form["edges"])[0])
        assert (form["minimum"], form["maximum"]) == (min(known)[0], max(known)[0])
        assert form["mean"] == pytest.approx(np.mean([value for value, _ in known]), rel=1e-9, abs=1e-6)


def test_a_count_has_a_bin_for_each_whole_number() -> None:
    form = distribution(table([(k / 100.0, None, "pass") for k in (2, 5, 5)])).form()
    assert form["edges"] == [1.5, 2.5, 3.5, 4.5, 5.5]
    assert form["counts"] == {"pass": [1, 0, 0, 2]}


def test_one_value_alone_has_a_span() -> None:
    form = distribution(table([(0.123, None, "pass")])).form()
    assert form["edges"][0] < 12.3 < form["edges"][-1]


def test_a_figure_asked_for_is_shown_once() -> None:
    names = [figure.name for figure in reported_measures(["braking_distance_m", "locked_time_s_3"])]
    assert names.count("braking distance") == 1
    assert names[-1] == "locked_time_s_3"
