"""Which cases are meant, and their parts."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.campaign import ExpressionError
from uictest.sweep import Selection, select
from uictest.sweep.running.simulating import Device

from ..conftest import Load


def test_an_expression_selects_by_id(load: Load) -> None:
    plan = load()
    selection = select(plan, "friction=0.10 and not command=80")
    assert plan.ids(selection.stretch(0, selection.size)) == ["study[friction=0.10,command=100]"]
    assert select(plan, "study.sweep").size == 6
    assert select(plan, "nothing").size == 0
    with pytest.raises(ExpressionError):
        select(plan, "and")


class Sized:
    """A plan as far as its size goes."""

    def __init__(self, size: int) -> None:
        self.size = size


@given(st.integers(1, 3_000_000))
def test_parts_are_all_cases_once_and_of_a_bounded_size(size: int) -> None:
    selection = Selection(Sized(size))  # type: ignore[arg-type]
    edges = [selection.part(0)[0], selection.part(selection.parts - 1)[-1]]
    assert edges == [0, size - 1]
    assert selection.part(0).size <= selection.part_size <= 256
    assert sum(selection.part(number).size for number in (0, selection.parts - 1)[: selection.parts]) <= size


@pytest.mark.parametrize(
    ("size", "device", "part"),
    [
        (10, "cpu", 16),
        (448, "cpu", 16),
        (3000, "cpu", 93),
        (10**6, "cpu", 256),
        (3000, "cuda", 375),
        (10**6, "cuda", 65_536),
    ],
)
def test_a_part_is_a_share_of_the_cases_between_bounds(size: int, device: Device, part: int) -> None:
    assert Selection(Sized(size), device=device).part_size == part  # type: ignore[arg-type]


def test_parts_of_a_selection(load: Load) -> None:
    selection = Selection(load(), np.array([5, 1, 3]))
    assert (selection.size, selection.parts) == (3, 1)
    assert selection.part(0).tolist() == [5, 1, 3]
