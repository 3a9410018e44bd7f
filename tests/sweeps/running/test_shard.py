"""Shards of a sweep."""

import pytest
from hypothesis import given, strategies as st

from uictest.running.chunked import Shard, parse_shard


@given(st.integers(0, 50), st.integers(1, 12))
def test_shards_are_all_chunks_once(chunks, count):
    shards = [Shard(number, count).chunk_numbers(chunks) for number in range(1, count + 1)]
    assert sorted(number for shard in shards for number in shard) == list(range(chunks))
    assert max(map(len, shards)) - min(map(len, shards)) <= 1


def test_written_form():
    assert parse_shard("2/8") == Shard(2, 8)


@pytest.mark.parametrize("text", ["0/3", "4/3", "1", "1/0", "a/b", "1/2/3", "-1/2"])
def test_what_is_no_shard(text):
    with pytest.raises(ValueError, match="is not a shard"):
        parse_shard(text)
