import numpy as np
from hypothesis import given, strategies as st

from uictest.report.traces.trace import extremes, thinned

_SAMPLES = st.lists(st.integers(-50, 50) | st.none(), min_size=1, max_size=300)


@given(_SAMPLES, st.integers(1, 40))
def test_no_extreme_and_no_gap_of_a_column_is_lost(samples, width):
    y = np.array([np.nan if value is None else value for value in samples], dtype=float)
    columns = np.arange(len(y)) // width
    rows = extremes(columns.astype(float), y)
    assert np.array_equal(rows, np.unique(rows))
    for column in np.unique(columns):
        every, kept = y[columns == column], y[rows[columns[rows] == column]]
        assert np.isnan(every).any() == np.isnan(kept).any()
        if np.isfinite(every).any():
            assert (np.nanmin(kept), np.nanmax(kept)) == (np.nanmin(every), np.nanmax(every))


@given(_SAMPLES, st.integers(1, 400))
def test_a_thinned_series_keeps_its_ends_and_is_short(samples, bins):
    y = np.array([np.nan if value is None else value for value in samples], dtype=float)
    rows = thinned(y, bins)
    assert (rows[0], rows[-1]) == (0, len(y) - 1)
    assert len(rows) <= 3 * bins + 2
