"""What machine code is called with follows from what it takes, and nothing else is handed to it."""

from typing import Any, NamedTuple

import numpy as np
import pytest

from uictest.rig.kernel.arguments import Length, at, lengths, passed

POINT = np.dtype([("x", "f8"), ("n", "i8")])
CARS, ROWS = Length("cars"), Length("rows")


class Pair(NamedTuple):
    first: Any
    second: Any


def address(array):
    return array.ctypes.data


def test_lengths_come_first_then_addresses_and_whole_numbers_in_their_order():
    arguments = (at(POINT, CARS), Pair(at("f8", ROWS, 3), int), at("i8", 4 * CARS), at(POINT))
    points, table, numbers = np.zeros(5, POINT), np.zeros((7, 3)), np.zeros(20, "i8")
    record = np.zeros(2, POINT)
    values = points, Pair(table, 11), numbers, record[1]
    assert lengths(arguments) == ["cars", "rows"]
    assert passed(arguments, values) == (
        *(5, 7),
        *(address(points), address(table), 11, address(numbers), address(record[1:])),
    )


def test_the_first_array_with_a_length_decides_it():
    arguments = at("f8", CARS - 1), at("f8", 2 * (CARS - 1)), at("f8", CARS)
    cars, *_ = passed(arguments, (np.zeros(3), np.zeros(6), np.zeros(4)))
    assert cars == 4


@pytest.mark.parametrize(
    "value",
    [
        np.zeros(5),  # another length than the first array says
        np.zeros((4, 1)),
        np.zeros(4, np.float32),
        np.zeros(8)[::2],
        np.zeros(()),
    ],
    ids=["length", "dimensions", "layout", "strides", "scalar"],
)
def test_what_lies_otherwise_is_refused(value):
    with pytest.raises(TypeError, match=r"expected \(.*\) contiguous float64, found"):
        passed((at("f8", CARS), at("f8", CARS)), (np.zeros(4), value))


def test_a_length_that_no_number_gives_is_refused():
    with pytest.raises(TypeError, match=r"expected \(6,\) contiguous"):
        passed((at("f8", 2 * CARS),), (np.zeros(7),))


def test_a_table_with_too_few_dimensions_is_refused():
    with pytest.raises(TypeError, match="contiguous"):
        passed((at("f8", ROWS, 3),), (np.zeros(3),))
