"""Whole numbers in lanes against numpy's, and a generator of random bits against itself one by one."""

import numba
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from uictest.core import lanes
from uictest.core.lanes import select, translate, vectors
from uictest.core.physics.sensors import bell, threefry

WIDTH = 8
PAIR = np.dtype((np.record, [("a", "i8"), ("b", "i8"), ("result", "i8"), ("number", "f8")]))
numbers = st.lists(st.integers(-(2**63), 2**63 - 1), min_size=WIDTH, max_size=WIDTH)

OPERATIONS = {
    "add": lambda a, b: a + b,
    "multiply": lambda a, b: a * b,
    "and": lambda a, b: a & b,
    "or": lambda a, b: a | b,
    "xor": lambda a, b: a ^ b,
    "left": lambda a, b: a << 13,
    "right": lambda a, b: b >> 13,
    "number on the left": lambda a, b: 0x1BD11BDA ^ a,
    "number on the right": lambda a, b: b + 5,
}
CHOICES = {
    "less": (lambda a, b: select(a < b, a, b), lambda a, b: np.where(a < b, a, b)),
    "less than a number": (lambda a, b: select(b < 3, a, 0), lambda a, b: np.where(b < 3, a, 0)),
    "equal": (
        lambda a, b: select(a & 1 == b & 1, 7, a + 1),
        lambda a, b: np.where(a & 1 == b & 1, 7, a + 1),
    ),
}


def applied(function):
    """Compile ``function(a, b)`` of whole numbers in lanes and call it on numbers."""
    compiled = numba.njit(function)

    @numba.njit
    def apply(block):
        record = vectors(block)
        record.result = compiled(record.a, record.b)

    def call(a, b):
        block = lanes.block(PAIR, WIDTH)
        block["a"], block["b"] = a, b
        apply(block)
        return np.array(block["result"][0])

    return call


@pytest.fixture(scope="module", params=OPERATIONS)
def operation(request):
    function = OPERATIONS[request.param]
    return applied(function), function


@given(a=numbers, b=numbers)
@settings(deadline=None)
def test_operations_are_those_of_numpy(operation, a, b):
    in_lanes, in_numpy = operation
    np.testing.assert_array_equal(in_lanes(a, b), in_numpy(np.array(a), np.array(b)))


@pytest.fixture(scope="module", params=CHOICES)
def choice(request):
    in_lanes, in_numpy = CHOICES[request.param]
    return applied(in_lanes), in_numpy


@given(a=numbers, b=numbers)
@settings(deadline=None)
def test_choices_are_those_of_numpy(choice, a, b):
    in_lanes, in_numpy = choice
    np.testing.assert_array_equal(in_lanes(a, b), in_numpy(np.array(a), np.array(b)))


def test_a_counter_counts_in_every_lane():
    @numba.njit
    def count(block):
        record = vectors(block)
        record.a += 1

    block = lanes.block(PAIR, WIDTH)
    block["a"] = np.arange(WIDTH) - 3
    count(block)
    np.testing.assert_array_equal(block["a"][0], np.arange(WIDTH) - 2)


def test_a_sum_with_a_float_is_a_float():
    @numba.njit
    def halve(block):
        record = vectors(block)
        record.number = (record.a + 1.0) * 0.5

    block = lanes.block(PAIR, WIDTH)
    block["a"] = np.arange(WIDTH) - 3
    halve(block)
    np.testing.assert_array_equal(block["number"][0], (np.arange(WIDTH) - 2) * 0.5)


def test_noise_in_lanes_has_the_bits_of_noise_one_by_one():
    in_lanes, together = translate(threefry, numba.njit, {}), translate(bell, numba.njit, {})

    @numba.njit
    def draw(block):
        record = vectors(block)
        word_0, word_1 = in_lanes(record.a, record.b, record.result, 35)
        record.number = together(word_0, word_1)

    block = lanes.block(PAIR, WIDTH)
    seeds, cases, cycles = (np.arange(WIDTH) * k + k for k in (7, 2**31, 1))
    cases &= 0xFFFFFFFF
    block["a"], block["b"], block["result"] = seeds, cases, cycles
    draw(block)
    expected = [
        bell(*threefry(*key, 35)) for key in zip(seeds.tolist(), cases.tolist(), cycles.tolist(), strict=True)
    ]
    assert block["number"][0].tolist() == expected
