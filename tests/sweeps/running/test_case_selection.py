"""Which cases are meant, and their chunks."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.running.campaign import ExpressionError
from uictest.running.chunked import CaseSelection, select_cases


def test_an_expression_selects_by_id_and_chunks_are_those_of_a_selection(load):
    plan = load()
    selection = select_cases(plan, "friction=0.10 and not command=80")
    assert plan.ids(selection.indices(0, selection.size)) == ["study[friction=0.10,command=100]"]
    assert select_cases(plan, "study.sweep").size == 6
    assert select_cases(plan, "nothing").size == 0
    with pytest.raises(ExpressionError):
        select_cases(plan, "and")
    selection = CaseSelection(load(), np.array([5, 1, 3]))
    assert (selection.size, selection.chunks) == (3, 1)
    assert selection.chunk(0).tolist() == [5, 1, 3]


class Sized:
    """A plan as far as its size goes."""

    def __init__(self, size):
        self.size = size


@given(st.integers(1, 3_000_000))
def test_chunks_are_all_cases_once_and_of_a_bounded_size(size):
    selection = CaseSelection(Sized(size))
    edges = [selection.chunk(0)[0], selection.chunk(selection.chunks - 1)[-1]]
    assert edges == [0, size - 1]
    assert selection.chunk(0).size <= selection.chunk_size <= 4096
    assert (
        sum(selection.chunk(number).size for number in (0, selection.chunks - 1)[: selection.chunks]) <= size
    )


@pytest.mark.parametrize(
    ("size", "chunk"), [(10, 16), (448, 16), (3000, 93), (50_000, 1024), (10**5, 1562), (10**6, 4096)]
)
def test_a_chunk_is_a_fraction_of_the_cases_between_bounds(size, chunk):
    assert CaseSelection(Sized(size)).chunk_size == chunk
