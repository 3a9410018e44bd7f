"""Attributes of records in lanes."""

import numba
import numpy as np
import pytest
from numba.core.errors import TypingError

from uictest.core import lanes
from uictest.core.lanes import copy_from_lane, copy_to_lane, lane, vectors

LAYOUT = np.dtype((np.record, [("speed", "f8"), ("mode", "i8"), ("load", "f8")]))
WIDTHS = [2, 4, 8, 16]
BIG = 2**62 + 1
"""An integer that no double-precision number holds."""


def counted(width):
    """Three records of lanes with all fields different."""
    block = lanes.block(LAYOUT, width, 3)
    for k, name in enumerate(("speed", "mode", "load")):
        block[name] = np.arange(3 * width).reshape(3, width) + 1000 * k
    return block


@pytest.mark.parametrize("width", WIDTHS)
def test_attributes_of_vectors_are_the_fields_of_all_lanes(width):
    @numba.njit
    def move(block):
        records = vectors(block)
        for i in range(3):
            records[i].load = records[i].speed + records[i].load

    block, before = counted(width), counted(width)
    move(block)
    assert np.array_equal(block["load"], before["speed"] + before["load"])
    assert np.array_equal(block["speed"], before["speed"])
    assert np.array_equal(block["mode"], before["mode"])


@pytest.mark.parametrize("width", WIDTHS)
def test_one_lane_leaves_the_others_alone(width):
    @numba.njit
    def change(block, number):
        record = lane(block, number)[1]
        record.speed = -record.speed
        record.mode = record.mode + 1
        record.load = 7

    for number in range(width):
        block, expected = counted(width), counted(width)
        change(block, number)
        expected["speed"][1, number] *= -1
        expected["mode"][1, number] += 1
        expected["load"][1, number] = 7
        assert block.tobytes() == expected.tobytes()


def test_a_number_stored_into_a_vector_fills_every_lane():
    @numba.njit
    def reset(block):
        vectors(block).load = 0.5
        vectors(block)[2].load = 3

    block = counted(8)
    reset(block)
    assert np.all(block["load"][0] == 0.5)
    assert np.all(block["load"][2] == 3.0)


def test_integers_keep_all_their_bits():
    @numba.njit
    def shift(block):
        record = lane(block, 3)
        record.mode = (record.mode << 1) | 1

    block = counted(8)
    block["mode"][0, 3] = BIG >> 1
    shift(block)
    assert block["mode"][0, 3] == BIG


def test_put_copies_every_field_of_a_record():
    @numba.njit
    def copy(block, records):
        copy_to_lane(lane(block, 5)[2], records[0])

    block = counted(8)
    record = np.array([(1.5, BIG, -0.0)], LAYOUT)
    copy(block, record)
    assert all(block[name][2, 5].tobytes() == record[name].tobytes() for name in record.dtype.names or ())


def test_take_copies_what_a_lane_has_and_leaves_the_rest():
    @numba.njit
    def copy(records, block):
        copy_from_lane(records[1], lane(block, 5)[2])

    block = counted(8)
    block["mode"][2, 5] = BIG
    records = np.full(2, 7, np.dtype([("table", "f8", (3,)), *LAYOUT.descr]))
    copy(records, block)
    assert all(records[name][1].tobytes() == block[name][2, 5].tobytes() for name in LAYOUT.names or ())
    assert records["table"].tolist() == [[7.0] * 3] * 2
    assert records["speed"][0] == 7.0


def test_a_record_without_a_field_of_the_lane_takes_nothing():
    @numba.njit
    def copy(records, block):
        copy_from_lane(records[0], lane(block, 0))

    with pytest.raises(TypingError, match="copy_from_lane"):
        copy(np.zeros(1, np.dtype([("speed", "f8")])), counted(8))


def test_integer_fields_are_no_vectors():
    @numba.njit
    def read(block):
        vectors(block).load = vectors(block).mode

    with pytest.raises(TypingError, match="mode"):
        read(counted(8))


def test_an_unknown_field_is_named():
    @numba.njit
    def read(block):
        vectors(block).sped = 1.0

    with pytest.raises(TypingError, match="sped"):
        read(counted(8))


def test_a_block_may_lie_anywhere():
    @numba.njit
    def double(block):
        record = vectors(block)
        record.load = record.load * 2.0

    aligned = counted(8)[:1]
    memory = np.zeros(aligned.nbytes + 8, np.uint8)
    shifted = memory[8:].view(aligned.dtype)
    shifted[:] = aligned
    double(shifted)
    assert np.array_equal(shifted["load"], 2.0 * aligned["load"])


def test_a_write_is_seen_through_every_view_of_its_field():
    """The compiler may keep a number in a register only as long as nothing writes its field."""

    @numba.njit
    def change(block, i, number):
        records, one = vectors(block), lane(block, number)
        records[0].load = records[0].speed
        one[i].speed = 50.0
        records[1].load = records[0].speed
        records[i].speed = records[i].speed + 1.0
        return one[0].speed, one[1].load

    block = counted(4)
    assert change(block, 0, 2) == (51.0, 50.0)
    assert block["speed"][0].tolist() == [1.0, 2.0, 51.0, 4.0]
    assert block["load"][0].tolist() == [0.0, 1.0, 2.0, 3.0]
    assert block["load"][1].tolist() == [0.0, 1.0, 50.0, 3.0]


def test_writing_one_field_does_not_make_the_compiler_read_another_again():
    @numba.njit
    def move(block, other):
        vectors(other).load = vectors(block).speed + 1.0
        vectors(block).load = vectors(block).speed + 2.0

    block, other = counted(4), counted(4)
    move(block, other)
    (optimised,) = move.inspect_llvm().values()
    assert optimised.count("load <4 x double>") == 1
