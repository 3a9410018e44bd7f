"""Code for one case, run on the numbers of many: the same bits, whatever way each case takes through it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.ensemble import Places, alike, by_way, ensemble

finite = st.floats(-1e9, 1e9)


def kind_of_triangle(a: float, b: float) -> float:
    if a > b:
        return (a - b) ** 2 / 3.0
    if a == b:
        return math.inf
    return max(a * b, 1.0) + min(a, b)


def rounded(a: float, b: float) -> float:
    return round(a) + float(b)


def quotient(a: float, b: float) -> float:
    return a / b if b else 0.0


def written(a: float, b: float) -> str:
    return f"{a:.3g} of {b}"


FUNCTIONS = (kind_of_triangle, rounded, quotient, written)


def by_ways(function: Callable[[float, float], object], a: list[float], b: list[float]) -> list[object]:
    """The results of a function for each case, by its ways."""
    x, y = np.array(a), np.array(b)
    results: list[object] = [None] * len(a)
    for places, result in by_way(
        lambda places: function(ensemble(x[places]), ensemble(y[places])),
        lambda place: function(a[place], b[place]),
        np.arange(len(a)),
    ):
        numbers = np.broadcast_to(np.asarray(result), places.shape).tolist()
        for place, number in zip(places.tolist(), numbers, strict=True):
            results[place] = number
    return results


@pytest.mark.parametrize("function", FUNCTIONS)
@given(st.lists(st.tuples(finite, finite), min_size=1, max_size=20))
def test_each_case_has_the_result_that_it_has_alone(
    function: Callable[[float, float], object], pairs: list[tuple[float, float]]
) -> None:
    a, b = (list(column) for column in zip(*pairs, strict=True))
    assert repr(by_ways(function, a, b)) == repr([function(*pair) for pair in pairs])


def test_cases_that_take_the_same_way_go_it_together() -> None:
    calls: list[int] = []

    def sign(places: Places) -> float:
        calls.append(places.size)
        return 1.0 if ensemble(np.array([-1.0, 2.0, -3.0, 4.0, 5.0])[places]) > 0.0 else -1.0

    def alone(place: int) -> float:
        raise AssertionError(place)

    groups = {tuple(places.tolist()): sign for places, sign in by_way(sign, alone, np.arange(5))}
    assert groups == {(1, 3, 4): 1.0, (0, 2): -1.0}
    assert calls == [5, 3, 2]


def test_an_error_is_that_of_the_case() -> None:
    def alone(place: int) -> float:
        return 1.0 / [1.0, 0.0][place]

    with pytest.raises(ZeroDivisionError):
        list(by_way(lambda places: 1.0 / ensemble(np.array([1.0, 0.0])[places]), alone, np.arange(2)))  # type: ignore[arg-type, return-value]


def test_nan_is_neither_greater_nor_less_and_no_reason_to_go_alone() -> None:
    def is_greater(number: float) -> bool:
        return bool(number > 0.0)

    def alone(place: int) -> bool:
        raise AssertionError(place)

    numbers = np.array([math.nan, 1.0, math.nan, 2.0])
    found = list(by_way(lambda places: is_greater(ensemble(numbers[places])), alone, np.arange(4)))  # type: ignore[arg-type]
    assert [(places.tolist(), greater) for places, greater in found] == [([1, 3], True), ([0, 2], False)]


@pytest.mark.parametrize("exponent", [2, 0.5, 3, -1, 1.5])
def test_powers_have_the_bits_of_python(exponent: float) -> None:
    numbers = np.exp(np.random.default_rng(3).uniform(-60.0, 60.0, 20_000))
    assert (ensemble(numbers) ** exponent).tolist() == [number**exponent for number in numbers.tolist()]


@given(st.lists(st.tuples(*(st.integers(0, 3) for _ in range(3))), max_size=30))
def test_cases_are_alike_where_all_their_numbers_are(rows: list[tuple[int, int, int]]) -> None:
    columns = np.array(rows, np.int8).reshape(-1, 3).T
    groups = [places.tolist() for places in alike(columns, len(rows))]
    assert sorted(place for group in groups for place in group) == list(range(len(rows)))
    assert all(
        group == [k for k, row in enumerate(rows) if row == rows[group[0]]] for group in groups if group
    )
