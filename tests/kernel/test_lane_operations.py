"""Each operation on lanes against numpy's, bit for bit, in the registers of every level of this processor."""

import ctypes
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from kernel import alone, contents
from kernel.records import lane_struct, struct as struct_of
from uictest.core.physics import mass_flow, orifice_law
from uictest.core.physics.sensors import bell, threefry
from uictest.rig.kernel.arguments import Length, at, block, block_layout, passed
from uictest.rig.kernel.library import WIDTHS, Entry, processors

from . import lane_operations

FLOATS = {
    "add": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "div": np.divide,
    "minimum": lambda a, b: np.where(a < b, a, b),
    "maximum": lambda a, b: np.where(a > b, a, b),
    "less": np.less,
    "less_equal": np.less_equal,
    "greater": np.greater,
    "greater_equal": np.greater_equal,
    "equal": np.equal,
    "unequal": np.not_equal,
    "select": lambda a, b: np.where(a > 0.0, a, b),
    "both": lambda a, b: np.where((a > 0.0) & (b > 0.0), a, b),
    "either": lambda a, b: np.where((a > 0.0) | (b > 0.0), a, b),
    "neither": lambda a, b: np.where(~((a > 0.0) | (b > 0.0)), a, b),
    "negative": lambda a, b: -a,
    "size": lambda a, b: np.abs(a),
    "floor": lambda a, b: np.floor(a),
    "sqrt": lambda a, b: np.sqrt(a),
    "number_on_the_left": lambda a, b: 3.0 - a,
    "number_on_the_right": lambda a, b: a / 3,
    # Of e it is e^2 when product and sum are fused, and 0 when the product is rounded.
    "rounded_twice": lambda a, b: 1.0 - (1.0 + a) * (1.0 - a),
    "not_reordered": lambda a, b: (a + b) - a,
    "in_place": lambda a, b: ((a + b) * 2.0 - a) / b,
}
WHOLE = {
    "add": np.add,
    "mul": np.multiply,
    "bit_and": np.bitwise_and,
    "bit_or": np.bitwise_or,
    "bit_xor": np.bitwise_xor,
    "left": lambda a, b: a << 13,
    "right": lambda a, b: b >> 13,
    "number_on_the_left": lambda a, b: 0x1BD11BDA ^ a,
    "number_on_the_right": lambda a, b: b + 5,
    "less": lambda a, b: np.where(a < b, a, b),
    "less_than_a_number": lambda a, b: np.where(b < 3, a, 0),
    "equal": lambda a, b: np.where(a & 1 == b & 1, 7, a + 1),
    "any_bit_is_true": lambda a, b: np.where(a & 1, a, b),
}
OF_FLOATS = np.dtype((np.record, [(name, "f8") for name in ("a", "b", "fused", *FLOATS)]))
OF_WHOLE = np.dtype(
    (
        np.record,
        [(name, "i8") for name in ("a", "b", "counted", "seed", "place", "cycle", *WHOLE)]
        + [("number", "f8"), ("noise", "f8")],
    )
)
RECORD = np.dtype((np.record, [("speed", "f8"), ("table", "f8", 3), ("mode", "i8"), ("load", "f8")]))
LAYOUTS = {"Floats": OF_FLOATS, "WholeNumbers": OF_WHOLE, "Record": RECORD}
FIELDS = ("speed", "mode", "load")
BIG = 2**62 + 1
"""A whole number that no double-precision number holds."""
ORIFICE = (1.0, 1.0, 1e-8, *orifice_law(0.35, 0.995))


def entries(width):
    """What is called, with blocks of so many lanes."""

    def entry(name, *arguments):
        return Entry(f"{lane_operations.__name__}:{name}", arguments)

    records, rows = at(block_layout(RECORD, width), 3), Length("rows")
    of_each = at(block_layout(OF_FLOATS, width), 1), at(block_layout(OF_WHOLE, width), 1)
    listed = [
        *(entry("on_floats", of_each[0]), entry("on_whole_numbers", of_each[1]), entry("fill", records)),
        *(entry("change_one_lane", records, int), entry("see_each_other", records, int, int)),
        *(entry(name, records, at(RECORD, 2), int) for name in ("copy_there", "copy_back")),
        *(entry("fused_one_by_one", at("f8", rows, 4)), entry("flow_through_orifices", of_each[0])),
    ]
    return {each.function.partition(":")[2]: each for each in listed}


class Operations:
    """The operations compiled for one level of the processor."""

    def __init__(self, level, folder):
        self.level, self.width = level, WIDTHS[level]
        self.entries = entries(self.width)
        program, types = contents.begun(), {}
        for name, layout in LAYOUTS.items():
            program.add(struct_of(name, layout) + lane_struct(name, layout))
            types |= {layout: name, block_layout(layout, self.width): f"{name}Lanes<Vector, Whole>"}
        for each in self.entries.values():
            program.add(contents.exported(program, each, types))
        self.library = alone.load(program, folder, level)

    def call(self, name, *values):
        given_values = passed(self.entries[name].arguments, values)
        prototype = ctypes.CFUNCTYPE(*[ctypes.c_int64] * (len(given_values) + 1))
        return prototype((f"{self.entries[name].symbol}_{self.level}", self.library))(*given_values)

    def counted(self):
        """Three records of lanes with all fields different."""
        records = block(RECORD, self.width, 3)
        for k, name in enumerate(FIELDS):
            records[name] = np.arange(3 * self.width).reshape(3, self.width) + 1000 * k
        return records


@pytest.fixture(name="operations", scope="module", params=processors())
def _operations(request, tmp_path_factory):
    return Operations(request.param, tmp_path_factory.mktemp("lanes"))


def same_bits(a, b):
    """Equality of bits; the payload of a NaN is nobody's business."""
    return bool(np.all((a.view(np.int64) == b.view(np.int64)) | (np.isnan(a) & np.isnan(b))))


eight_floats = st.lists(st.floats(width=64), min_size=8, max_size=8)
eight_numbers = st.lists(st.integers(-(2**63), 2**63 - 1), min_size=8, max_size=8)


@given(a=eight_floats, b=eight_floats)
def test_operations_on_floats_are_those_of_numpy(operations, a, b):
    records = block(OF_FLOATS, operations.width)
    records["a"], records["b"] = a[: operations.width], b[: operations.width]
    operations.call("on_floats", records)
    a, b = np.array(a[: operations.width]), np.array(b[: operations.width])
    with np.errstate(all="ignore"):
        for name, in_numpy in FLOATS.items():
            assert same_bits(records[name][0], np.asarray(in_numpy(a, b), np.float64)), name


@given(a=eight_numbers, b=eight_numbers)
def test_operations_on_whole_numbers_are_those_of_numpy(operations, a, b):
    records = block(OF_WHOLE, operations.width)
    records["a"], records["b"] = a[: operations.width], b[: operations.width]
    records["counted"] = np.arange(operations.width) - 3
    operations.call("on_whole_numbers", records)
    a, b = np.array(a[: operations.width]), np.array(b[: operations.width])
    for name, in_numpy in WHOLE.items():
        np.testing.assert_array_equal(records[name][0], in_numpy(a, b), name)
    np.testing.assert_array_equal(records["number"][0], (a + 1.0) * 0.5)
    np.testing.assert_array_equal(records["counted"][0], np.arange(operations.width) - 2)


def test_noise_in_lanes_has_the_bits_of_noise_one_by_one(operations):
    records = block(OF_WHOLE, operations.width)
    keys = [np.arange(operations.width) * k + k for k in (7, 2**31, 1)]
    keys[1] &= 0xFFFFFFFF
    records["seed"], records["place"], records["cycle"] = keys
    operations.call("on_whole_numbers", records)
    expected = [bell(*threefry(*key, 35)) for key in zip(*(each.tolist() for each in keys), strict=True)]
    assert records["noise"][0].tolist() == expected


# A product and its rounding error are far from the ends of the range.
moderate = st.floats(1e-100, 1e100) | st.floats(-1e100, -1e-100)


@given(a=moderate, b=moderate, c=moderate, nearly=st.integers(-3, 3))
@settings(max_examples=300)
def test_a_fused_product_is_rounded_once(operations, a, b, c, nearly):
    """By the instruction where the processor has it; the lowest level does as `arithmetic.fma` says."""
    close = -(a * b) * (1.0 + nearly * 2.0**-52)
    rows = np.array([[a, b, c, 0.0], [a, b, close, 0.0], [a, -b, 0.5, 0.0]])
    operations.call("fused_one_by_one", rows)
    for *given_numbers, found in rows:
        of_a, of_b, of_c = map(Fraction, given_numbers)
        assert found == float(of_a * of_b + of_c)
    records = block(OF_FLOATS, operations.width)
    records["a"], records["b"] = a, -b
    operations.call("on_floats", records)
    assert np.all(records["fused"] == rows[2, 3])


def test_a_law_of_the_rig_gives_the_bits_of_plain_python(operations):
    """Flow through an orifice: choked, subsonic, nearly none, and none, either way."""
    plain, found = [], []
    for pressure in np.geomspace(1e5, 9e5, 20):
        ratios = np.resize([0.1, 0.34, 0.36, 0.8, 0.994, 0.996, 1.0, 1.2, 4.0], 3 * operations.width)
        for some in ratios.reshape(3, operations.width):
            records = block(OF_FLOATS, operations.width)
            records["a"], records["b"] = pressure, pressure * some
            operations.call("flow_through_orifices", records)
            found += records["add"][0].tolist()
            plain += [mass_flow(pressure, pressure * float(each), *ORIFICE) for each in some]
    assert len(set(plain)) > 80
    assert same_bits(np.array(found), np.array(plain))


def test_one_lane_is_changed_alone_and_a_number_stored_into_a_vector_fills_every_lane(operations):
    for number in range(operations.width):
        records, expected = operations.counted(), operations.counted()
        records["mode"][1, number] = expected["mode"][1, number] = BIG >> 1
        operations.call("change_one_lane", records, number)
        expected["speed"][1, number] *= -1
        expected["mode"][1, number] = BIG
        expected["load"][1, number] = 7.0 + expected["speed"][1, number]
        assert records.tobytes() == expected.tobytes()
    records, before = operations.counted(), operations.counted()
    operations.call("fill", records)
    assert np.all(records["load"][0] == 0.5) and np.all(records["load"][2] == 3.0)
    assert np.array_equal(records["load"][1], before["load"][1])


def test_what_is_copied_to_a_lane_or_from_it_is_every_field_and_no_more(operations):
    records, given_records = operations.counted(), np.zeros(2, RECORD)
    given_records[0] = (1.5, (1.0, 2.0, 3.0), BIG, -0.0)
    expected = operations.counted()
    operations.call("copy_there", records, given_records, 1)
    for name in FIELDS:
        expected[name][2, 1] = given_records[name][0]
    assert records.tobytes() == expected.tobytes()
    records, taken = operations.counted(), np.full(2, 7, RECORD)
    records["mode"][2, 1] = BIG
    operations.call("copy_back", records, taken, 1)
    assert all(taken[name][1].tobytes() == records[name][2, 1].tobytes() for name in FIELDS)
    assert taken["table"].tolist() == [[7.0] * 3] * 2
    assert taken["speed"][0] == 7.0


def test_a_write_is_seen_through_every_view_of_its_field(operations):
    """The compiler may keep a number in a register only as long as nothing writes its field."""
    records, before = operations.counted(), operations.counted()
    operations.call("see_each_other", records, 0, 1)
    changed = before["speed"][0].copy()
    changed[1] = 50.0
    assert records["load"][0].tolist() == before["speed"][0].tolist()
    assert records["load"][1].tolist() == changed.tolist()
    assert records["speed"][0].tolist() == (changed + 1.0).tolist()
