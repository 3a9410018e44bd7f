"""Each operation of vectors against numpy's, bit for bit."""

from fractions import Fraction

import numba
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from numpy.typing import NDArray

from uictest.core import lanes, physics
from uictest.core.lanes import floor, fma, maximum, minimum, select, sqrt, translate, vectors
from uictest.core.physics import arithmetic, mass_flow, orifice_law

WIDTH = 8
PAIR = np.dtype((np.record, [("a", "f8"), ("b", "f8"), ("result", "f8")]))
numbers = st.lists(st.floats(width=64), min_size=WIDTH, max_size=WIDTH)
Numbers = NDArray[np.float64]


def applied(function):
    """Compile ``function(a, b)`` of vectors and call it on numbers."""
    compiled = numba.njit(error_model="numpy")(function)

    @numba.njit(error_model="numpy")
    def apply(block):
        record = vectors(block)
        record.result = compiled(record.a, record.b)

    def call(a, b):
        block = lanes.block(PAIR, WIDTH)
        block["a"], block["b"] = a, b
        apply(block)
        return np.array(block["result"][0])

    return call


BINARY = {
    "add": (lambda a, b: a + b, np.add),
    "sub": (lambda a, b: a - b, np.subtract),
    "mul": (lambda a, b: a * b, np.multiply),
    "truediv": (lambda a, b: a / b, np.divide),
    "minimum": (lambda a, b: minimum(a, b), lambda a, b: np.where(a < b, a, b)),
    "maximum": (lambda a, b: maximum(a, b), lambda a, b: np.where(a > b, a, b)),
    "lt": (lambda a, b: select(a < b, 1.0, 0.0), np.less),
    "le": (lambda a, b: select(a <= b, 1.0, 0.0), np.less_equal),
    "gt": (lambda a, b: select(a > b, 1.0, 0.0), np.greater),
    "ge": (lambda a, b: select(a >= b, 1.0, 0.0), np.greater_equal),
    "select": (lambda a, b: select(a > 0.0, a, b), lambda a, b: np.where(a > 0.0, a, b)),
    "and": (
        lambda a, b: select((a > 0.0) & (b > 0.0), a, b),
        lambda a, b: np.where((a > 0.0) & (b > 0.0), a, b),
    ),
    "or": (
        lambda a, b: select((a > 0.0) | (b > 0.0), a, b),
        lambda a, b: np.where((a > 0.0) | (b > 0.0), a, b),
    ),
    "neg": (lambda a, b: -a, lambda a, b: -a),
    "abs": (lambda a, b: abs(a), lambda a, b: np.abs(a)),
    "floor": (lambda a, b: floor(a), lambda a, b: np.floor(a)),
    "sqrt": (lambda a, b: sqrt(a), lambda a, b: np.sqrt(a)),
    "number on the left": (lambda a, b: 3.0 - a, lambda a, b: 3.0 - a),
    "number on the right": (lambda a, b: a / 3, lambda a, b: a / 3),
}


@pytest.fixture(scope="module", params=BINARY)
def operation(request):
    in_lanes, in_numpy = BINARY[request.param]
    return applied(in_lanes), in_numpy


def same_bits(a, b):
    """Equality of bits; the payload of a NaN is nobody's business."""
    return bool(np.all((a.view(np.int64) == b.view(np.int64)) | (np.isnan(a) & np.isnan(b))))


@given(a=numbers, b=numbers)
@settings(deadline=None)
def test_operations_give_the_bits_of_numpy(operation, a, b):
    in_lanes, in_numpy = operation
    with np.errstate(all="ignore"):
        expected = np.asarray(in_numpy(np.array(a), np.array(b)), np.float64)
    assert same_bits(in_lanes(a, b), expected)


def test_a_product_is_rounded_before_it_is_added():
    # 1 - (1 + e) (1 - e) is e^2 when product and sum are fused, and 0 when the product is rounded.
    difference = applied(lambda a, b: 1.0 - (1.0 + a) * (1.0 - a))
    assert np.all(difference(2.0**-30, 0.0) == 0.0)


# A product and its rounding error are far from the ends of the range.
moderate = st.floats(1e-100, 1e100) | st.floats(-1e100, -1e-100)


@given(a=moderate, b=moderate, c=moderate, nearly=st.integers(-3, 3))
@settings(deadline=None, max_examples=300)
def test_a_fused_product_is_rounded_once(fused, a, b, c, nearly):
    in_lanes, of_numbers = fused
    close = -(a * b) * (1.0 + nearly * 2.0**-52)
    for term in (c, close):
        exact = float(Fraction(a) * Fraction(b) + Fraction(term))
        assert np.all(in_lanes(a, b, term) == exact)
        assert of_numbers(a, b, term) == exact


def without_instruction(**replaced):
    """The fused multiply-add as it is written for processors that have none."""
    done = {getattr(arithmetic, name): function for name, function in replaced.items()}
    return translate(arithmetic.fma, numba.njit, done)


FUSED = {
    "instruction": (fma, fma),
    "source": (
        without_instruction(select=select, maximum=maximum),
        without_instruction(),
    ),
}


@pytest.fixture(scope="module", params=FUSED)
def fused(request):
    """A fused multiply-add in lanes, its third term a number, and of numbers alone."""
    fma_in_lanes, fma = FUSED[request.param]

    @numba.njit
    def of_numbers(a, b, c):
        return fma(a, b, c)

    @numba.njit
    def apply(block, c):
        record = vectors(block)
        record.result = fma_in_lanes(record.a, record.b, c)

    def in_lanes(a, b, c):
        block = lanes.block(PAIR, WIDTH)
        block["a"], block["b"] = a, b
        apply(block, c)
        return np.array(block["result"][0])

    return in_lanes, of_numbers


NAMES = ("fma", "maximum", "minimum", "select", "sqrt")
IN_LANES = {getattr(physics, name): getattr(lanes, name) for name in NAMES}


@pytest.mark.parametrize("width", [2, 4, 8, 16])
def test_a_law_of_the_rig_gives_the_bits_of_plain_python_at_any_width(width):
    """Flow through an orifice: choked, subsonic, nearly none, and none, either way."""
    law = translate(mass_flow, numba.njit(error_model="numpy"), dict(IN_LANES))
    orifice = (1.0, 1.0, 1e-8, *orifice_law(0.35, 0.995))

    @numba.njit(error_model="numpy")
    def apply(block):
        records = vectors(block)
        for i in range(16):
            record = records[i]
            record.result = law(record.a, record.b, *orifice)

    block = lanes.block(PAIR, width, 16)
    pressures = np.geomspace(1e5, 9e5, 16 * width)
    ratios = np.resize([0.1, 0.34, 0.36, 0.8, 0.994, 0.996, 1.0, 1.2, 4.0], 16 * width)
    block["a"], block["b"] = (values.reshape(16, width) for values in (pressures, pressures * ratios))
    apply(block)
    plain = [mass_flow(a, b, *orifice) for a, b in zip(block["a"].flat, block["b"].flat, strict=True)]
    assert len(set(plain)) > 14 * width
    assert same_bits(block["result"].reshape(-1), np.array(plain))


def test_a_sum_is_not_reordered():
    summed = applied(lambda a, b: (a + b) - a)
    assert np.all(summed(1e16, 1.0) == 0.0)


def test_operators_in_place():
    def in_place(a, b):
        result = a
        result += b
        result *= 2.0
        result -= a
        result /= b
        return result

    a, b = np.arange(WIDTH) + 0.1, np.arange(WIDTH) + 0.7
    assert same_bits(applied(in_place)(a, b), ((a + b) * 2.0 - a) / b)
