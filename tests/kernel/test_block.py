import numpy as np
import pytest

from uictest.rig.kernel.arguments import block
from uictest.rig.kernel.library import register_width

LAYOUT = np.dtype((np.record, [("speed", "f8"), ("mode", "i8")]))


@pytest.mark.parametrize("width", [2, 4, 8, 16])
def test_a_field_of_a_block_is_one_row_of_lanes(width):
    wheelsets = block(LAYOUT, width, 4)
    assert wheelsets["speed"].shape == (4, width)
    assert wheelsets["speed"].strides[1] == 8
    assert wheelsets["mode"].dtype == np.int64
    assert not wheelsets["speed"].any()


def test_a_field_of_several_numbers_is_left_out():
    table = np.dtype((np.record, [("speed", "f8"), ("slides", "f8", (21,)), ("mode", "i8")]))
    assert block(table, 8).dtype.names == ("speed", "mode")


def test_a_block_begins_at_a_cache_line():
    assert all(block(LAYOUT, 8, count).ctypes.data % 64 == 0 for count in range(1, 20))


def test_a_register_holds_a_power_of_two():
    assert register_width() in (2, 4, 8)
