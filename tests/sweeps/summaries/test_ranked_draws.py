"""Draws of requested ranks against all draws sorted, in memory that does not grow with their number."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.analysis.summaries.tails import RankedDraws, SmallestValues

numbers = st.lists(
    st.lists(st.one_of(st.floats(-9.0, 9.0).map(lambda x: round(x, 1)), st.just(np.nan)), max_size=9),
    max_size=9,
)


@given(numbers, st.integers(0, 12), st.integers(0, 12))
def test_ranks_are_those_of_all_draws_sorted(chunks, from_smallest, from_largest):
    draws = RankedDraws(from_smallest, from_largest)
    for chunk in chunks:
        draws.add(np.array(chunk, float))
    values = np.array([value for chunk in chunks for value in chunk], float)
    missing = np.isnan(values)
    assert (draws.draws, draws.without_value) == (values.size, np.count_nonzero(missing))
    # What has no value counts as the smallest from below, and as the largest from above.
    below, above = (np.sort(np.where(missing, end, values)) for end in (-np.inf, np.inf))
    for rank in range(1, min(from_smallest, values.size) + 1):
        expected = below[rank - 1]
        assert draws.lower(rank) == (expected if np.isfinite(expected) else None)
    for rank in range(1, min(from_largest, values.size) + 1):
        expected = above[-rank]
        assert draws.upper(rank) == (expected if np.isfinite(expected) else None)


@pytest.mark.parametrize("chunks", [1, 6, 60, 4_000])
@pytest.mark.parametrize("kept", [1, 30, 5_000])
def test_ranks_of_many_draws(kept, chunks):
    """So many that values are sorted out on the way: rising, falling and random chunks."""
    values = np.random.default_rng(2).normal(size=12_000)
    values[:4_000].sort()
    values[4_000:8_000] = np.sort(values[4_000:8_000])[::-1]
    draws = RankedDraws(kept, kept)
    for chunk in np.array_split(values, chunks):
        draws.add(chunk)
    expected = np.sort(values)
    assert [draws.lower(rank) for rank in range(1, kept + 1)] == expected[:kept].tolist()
    assert [draws.upper(rank) for rank in range(1, kept + 1)] == expected[::-1][:kept].tolist()


def test_draws_may_be_added_after_a_rank_was_asked_for_that_was_kept():
    smallest = SmallestValues(2)
    smallest.add(np.array([3.0, 1.0, 2.0]))
    assert smallest.of_rank(2) == 2.0
    smallest.add(np.array([0.0, 5.0]))
    assert (smallest.of_rank(1), smallest.of_rank(2)) == (0.0, 1.0)
    with pytest.raises(IndexError, match="rank 3 of the 2 smallest"):
        SmallestValues(2).of_rank(3)


def test_memory_does_not_grow_with_the_draws():
    def peak(chunks):
        generator = np.random.default_rng(1)
        tracemalloc.start()
        draws = RankedDraws(30, 30)
        for _ in range(chunks):
            draws.add(generator.normal(size=256))
        taken = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert draws.draws == 256 * chunks
        return taken

    # A column of the longer sweep alone would take 8 MB.
    assert max(peak(400), peak(4_000)) < 200_000
