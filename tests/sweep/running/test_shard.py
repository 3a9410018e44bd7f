"""Shares of a sweep."""

import pytest
from hypothesis import given, strategies as st

from uictest.sweep import Shard, parse_shard


@given(st.integers(0, 50), st.integers(1, 12))
def test_shares_are_all_parts_once(parts: int, count: int) -> None:
    shares = [Shard(number, count).of(parts) for number in range(1, count + 1)]
    assert sorted(number for share in shares for number in share) == list(range(parts))
    assert max(map(len, shares)) - min(map(len, shares)) <= 1


def test_written_form() -> None:
    assert parse_shard("2/8") == Shard(2, 8)


@pytest.mark.parametrize("text", ["0/3", "4/3", "1", "1/0", "a/b", "1/2/3", "-1/2"])
def test_what_is_no_share(text: str) -> None:
    with pytest.raises(ValueError, match="is not a share"):
        parse_shard(text)
