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

# In lanes and in numpy.
OPERATIONS = {
    "add": lambda a, b: a + b,
    "multiply": lambda a, b: a * b,
    "and": lambda a, b: a & b,
    "or": lambda a, b: a | b,
    "xor": lambda a, b: a ^ b,
    "left": lambda a, b: a << 13,
    "right": lambda a, b: b >> 13,
    "number_on_the_left": lambda a, b: 0x1BD11BDA ^ a,
    "number_on_the_right": lambda a, b: b + 5,
}
CHOICES = {
    "less": (lambda a, b: select(a < b, a, b), lambda a, b: np.where(a < b, a, b)),
    "less_than_a_number": (lambda a, b: select(b < 3, a, 0), lambda a, b: np.where(b < 3, a, 0)),
    "equal": (
        lambda a, b: select(a & 1 == b & 1, 7, a + 1),
        lambda a, b: np.where(a & 1 == b & 1, 7, a + 1),
    ),
}
FUNCTIONS = {name: (function, function) for name, function in OPERATIONS.items()} | CHOICES


@pytest.fixture(name="applied", scope="module")
def _applied():
    """Compile all functions in lanes together, and return what calls them on numbers."""
    layout = np.dtype(
        (np.record, [(name, "i8") for name in ("a", "b", *(f"of_{name}" for name in FUNCTIONS))])
    )
    inner = {f"own_{name}": lanes.compile_inner(in_lanes) for name, (in_lanes, _) in FUNCTIONS.items()}
    lines = [f"    record.of_{name} = own_{name}(record.a, record.b)" for name in FUNCTIONS]
    source = "\n".join(["def apply(block):", "    record = vectors(block)", *lines])
    exec(source, names := {"vectors": vectors, **inner})
    apply = numba.njit(names["apply"])

    def applied(a, b):
        block = lanes.block(layout, WIDTH)
        block["a"], block["b"] = a, b
        apply(block)
        return {name: block[f"of_{name}"][0] for name in FUNCTIONS}

    return applied


@given(a=numbers, b=numbers)
@settings(deadline=None)
def test_operations_and_choices_are_those_of_numpy(applied, a, b):
    in_lanes = applied(a, b)
    for name, (_, in_numpy) in FUNCTIONS.items():
        np.testing.assert_array_equal(in_lanes[name], in_numpy(np.array(a), np.array(b)), name)


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
