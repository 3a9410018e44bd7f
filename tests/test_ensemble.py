"""Code for one case, run on the numbers of many: the same bits, whatever way each case takes through it."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.ensemble import alike, by_way, case_by_case, ensemble

finite = st.floats(-1e9, 1e9)


def kind_of_triangle(a, b):
    if a > b:
        return (a - b) ** 2 / 3.0
    if a == b:
        return math.inf
    return max(a * b, 1.0) + min(a, b)


def rounded(a, b):
    return round(a) + float(b)


def quotient(a, b):
    return a / b if b else 0.0


def written(a, b):
    return f"{a:.3g} of {b}"


FUNCTIONS = (kind_of_triangle, rounded, quotient, written)


def by_ways(function, a, b):
    """The results of a function for each case, by its ways."""
    x, y = np.array(a), np.array(b)
    results = [None] * len(a)
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
def test_each_case_has_the_result_that_it_has_alone(function, pairs):
    a, b = (list(column) for column in zip(*pairs, strict=True))
    assert repr(by_ways(function, a, b)) == repr([function(*pair) for pair in pairs])


def test_cases_that_take_the_same_way_go_it_together():
    calls = []

    def sign(places):
        calls.append(places.size)
        return 1.0 if ensemble(np.array([-1.0, 2.0, -3.0, 4.0, 5.0])[places]) > 0.0 else -1.0

    def alone(place):
        raise AssertionError(place)

    groups = {tuple(places.tolist()): sign for places, sign in by_way(sign, alone, np.arange(5))}
    assert groups == {(1, 3, 4): 1.0, (0, 2): -1.0}
    assert calls == [5, 3, 2]


def test_an_error_is_that_of_the_case():
    def alone(place):
        return 1.0 / [1.0, 0.0][place]

    with pytest.raises(ZeroDivisionError):
        list(by_way(lambda places: 1.0 / ensemble(np.array([1.0, 0.0])[places]), alone, np.arange(2)))


def test_nan_is_neither_greater_nor_less_and_no_reason_to_go_alone():
    def is_greater(number):
        return bool(number > 0.0)

    def alone(place):
        raise AssertionError(place)

    numbers = np.array([math.nan, 1.0, math.nan, 2.0])
    found = list(by_way(lambda places: is_greater(ensemble(numbers[places])), alone, np.arange(4)))
    assert [(places.tolist(), greater) for places, greater in found] == [([1, 3], True), ([0, 2], False)]


@pytest.mark.parametrize("exponent", [2, 0.5, 3, -1, 1.5])
def test_powers_have_the_bits_of_python(exponent):
    numbers = np.exp(np.random.default_rng(3).uniform(-60.0, 60.0, 20_000))
    assert (ensemble(numbers) ** exponent).tolist() == [number**exponent for number in numbers.tolist()]


@given(st.lists(st.tuples(*(st.integers(0, 3) for _ in range(3))), max_size=30))
def test_cases_are_alike_where_all_their_numbers_are(rows):
    columns = np.array(rows, np.int8).reshape(-1, 3).T
    groups = [places.tolist() for places in alike(columns, len(rows))]
    assert sorted(place for group in groups for place in group) == list(range(len(rows)))
    assert all(
        group == [k for k, row in enumerate(rows) if row == rows[group[0]]] for group in groups if group
    )


@given(st.lists(st.tuples(finite, finite), min_size=1, max_size=20))
def test_a_function_that_looks_at_one_case_is_called_for_each(pairs):
    def looked_at(a, b):
        return float(f"{a:.5g}"), a + b

    a, b = (list(column) for column in zip(*pairs, strict=True))
    of_all = case_by_case(looked_at, ensemble(np.array(a)), ensemble(np.array(b)))
    assert [column.tolist() for column in of_all] == [*map(list, zip(*map(looked_at, a, b), strict=True))]
    assert case_by_case(looked_at, a[0], b[0]) == looked_at(a[0], b[0])
    one_for_all = case_by_case(looked_at, ensemble(np.array(a)), b[0])
    assert one_for_all[1].tolist() == [each + b[0] for each in a]
