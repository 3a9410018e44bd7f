"""What the generator takes gives the bits of plain Python."""

import ctypes
import struct
from types import FunctionType, SimpleNamespace
from typing import get_type_hints

import numpy as np
import pytest
from hypothesis import example, given, strategies as st

from kernel import alone, contents
from kernel.records import struct as struct_of
from uictest.rig.kernel.arguments import Length, at
from uictest.rig.kernel.library import Entry, processor

from . import constructs
from .conftest import exported, function_of

OF_NUMBERS = [
    each
    for each in vars(constructs).values()
    if isinstance(each, FunctionType)
    and each.__module__ == constructs.__name__
    and get_type_hints(each).get("return") in (float, int)
]
assert len(OF_NUMBERS) > 30
HUGE = 2**61
"""Sums of such numbers have 64 bits."""
VALUES = {
    float: st.floats(width=64) | st.sampled_from([0.0, -0.0, 0.5, 1.5, 2.5, -2.5, 1e22]),
    int: st.integers(-HUGE, HUGE) | st.integers(-20, 20),
    bool: st.booleans(),
}
POINT = np.dtype((np.record, [("x", "f8"), ("count", "i8"), ("table", "f8", 3), ("counts", "i4", 4)]))
ROWS = Length("rows")
ON_RECORDS = Entry(
    f"{constructs.__name__}:on_records", (at(POINT, 3), at("f8", ROWS), at("f8", ROWS, 2), int)
)


@pytest.fixture(name="library", scope="module")
def _library(tmp_path_factory):
    program = contents.begun()
    for function in OF_NUMBERS:
        exported(program, function)
    program.add(struct_of("Point", POINT))
    program.add(contents.exported(program, ON_RECORDS, {POINT: "Point"}))
    return alone.load(program, tmp_path_factory.mktemp("constructs"))


def bits_of(value):
    """The bits of a number; a NaN is like another, a truth like its number."""
    if isinstance(value, float):
        return "nan" if value != value else struct.pack("d", value)
    return int(value)


@pytest.mark.parametrize("function", OF_NUMBERS, ids=lambda function: function.__name__)
@given(data=st.data())
def test_numbers_have_the_bits_of_python(library, function, data):
    hints = get_type_hints(function)
    result = hints.pop("return")
    given_numbers = [data.draw(VALUES[kind]) for kind in hints.values()]
    expected = result(function(*given_numbers))
    assert bits_of(function_of(library, function)(*given_numbers)) == bits_of(expected)


@pytest.mark.parametrize("m", [-(2**63), -(2**63) + 1, 2**63 - 1])
@pytest.mark.parametrize("n", [3, -3, 7, 2**62])
def test_division_is_that_of_python_at_both_ends(library, m, n):
    for function in (constructs.floor_division, constructs.remainder):
        assert function_of(library, function)(m, n) == function(m, n)


counts = st.lists(st.integers(-9, 9) | st.just(100_000), min_size=4, max_size=4)
numbers = st.lists(st.floats(-1e9, 1e9), min_size=11, max_size=11)


@given(values=numbers, counts=counts, n=st.integers(0, 1))
@example(values=[0.0] * 11, counts=[0] * 4, n=0)
def test_records_and_arrays_are_changed_as_by_python(library, values, counts, n):
    points, row, table = np.zeros(3, POINT), np.array(values[:3]), np.array(values[3:9]).reshape(3, 2)
    points["x"], points["count"], points["counts"] = values[8:], counts[:3], counts
    points["table"] = np.array(values[:9]).reshape(3, 3)
    plain = [SimpleNamespace(**{name: each[name].tolist() for name in POINT.names}) for each in points]
    plain_row, plain_table = row.copy(), table.copy()
    constructs.on_records(plain, plain_row, plain_table, n)
    call = ctypes.CFUNCTYPE(*[ctypes.c_int64] * 6)((f"{ON_RECORDS.symbol}_{processor()}", library))
    call(3, points.ctypes.data, row.ctypes.data, table.ctypes.data, n)
    assert (row.tobytes(), table.tobytes()) == (plain_row.tobytes(), plain_table.tobytes())
    for record, expected in zip(points, plain, strict=True):
        for name in POINT.names:
            assert (
                record[name].tobytes() == np.array(getattr(expected, name), record[name].dtype).tobytes()
            ), name
