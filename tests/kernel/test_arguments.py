"""What machine code is called with follows from what it takes, and nothing else is handed to it."""

import os
from typing import Any, NamedTuple

import numpy as np
import pytest

from uictest.rig.kernel.arguments import Length, at, block, lengths, passed
from uictest.rig.kernel.library import WIDTHS, processor, processors, register_width

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


@pytest.mark.parametrize(
    ("argument", "shape", "told"),
    [(at("f8", 2 * CARS), 7, r"expected \(6,\) contiguous"), (at("f8", ROWS, 3), 3, "contiguous")],
    ids=["a length that no number gives", "too few dimensions"],
)
def test_an_array_that_no_length_fits_is_refused(argument, shape, told):
    with pytest.raises(TypeError, match=told):
        passed((argument,), (np.zeros(shape),))


LAYOUT = np.dtype((np.record, [("speed", "f8"), ("mode", "i8")]))


@pytest.mark.parametrize("width", [2, 4, 8, 16])
def test_a_field_of_a_block_is_one_row_of_lanes(width):
    wheelsets = block(LAYOUT, width, 4)
    assert wheelsets["speed"].shape == (4, width)
    assert wheelsets["speed"].strides[1] == 8
    assert wheelsets["mode"].dtype == np.int64
    assert not wheelsets["speed"].any()


def test_a_block_leaves_out_a_field_of_several_numbers_and_begins_at_a_cache_line():
    table = np.dtype((np.record, [("speed", "f8"), ("slides", "f8", (21,)), ("mode", "i8")]))
    assert block(table, 8).dtype.names == ("speed", "mode")
    assert all(block(LAYOUT, 8, count).ctypes.data % 64 == 0 for count in range(1, 20))


def test_a_register_of_this_processor_has_one_of_the_widths():
    assert register_width() == WIDTHS[processor()] in (2, 4, 8)
    assert processor() == processors()[-1] or "UICTEST_PROCESSOR" in os.environ
