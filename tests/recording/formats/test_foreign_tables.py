"""Text tables as other programs write them: understood, or refused with the line and what to declare."""

import re

import numpy as np
import pytest

from uictest.core.recording.formats import Dialect, UnreadableError
from uictest.core.recording.formats.file_formats import MOST_CHANNELS
from uictest.core.recording.formats.isolation import read_here

ROWS = "0.0,80.5,1\n0.1,80.25,2\n0.2,80.0,3\n"


def _read(path, content, dialect=None):
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    [group] = read_here("csv", path, dialect or Dialect()).groups
    return group


@pytest.fixture
def table(tmp_path):
    return tmp_path / "table.csv"


def test_a_line_of_units_below_the_names_is_found_and_no_other_taken_for_one(table):
    for units in ("s,km/h,bar", "[s],[km/h],[bar]", "(s),(km/h),(bar)", "s, km/h ,bar"):
        group = _read(table, f"t,v,p\n{units}\n{ROWS}")
        assert group.units == {"t": "s", "v": "km/h", "p": "bar"}
        np.testing.assert_array_equal(group.channels["v"], [80.5, 80.25, 80.0])
    assert list(_read(table, f"s,v,a\n{ROWS}").channels) == ["s", "v", "a"]
    group = _read(table, "t,v,MV\n0.0,80.5,fill\n0.1,80.25,vent\n")
    assert list(group.channels["MV"]) == ["fill", "vent"]


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        (f"Rig 7\nRun 12, May\n\nt,v,p\n{ROWS}", "have its names in line 4: set csv: {header_line: 4}"),
        (f"Report,,\nt,v,p\ns,km/h,bar\n{ROWS}", "have its names in line 2: set csv: {header_line: 2}"),
        (f"t,v,p\nTime,Speed,Pressure\n{ROWS}", "begin its samples in line 3: set csv: {first_line: 3}"),
        (
            "Rig\nt;v\ns;km/h\n0,0;80,5\n",
            'and have its names in line 2: set csv: {delimiter: ";", decimal: ",", header_line: 2}',
        ),
    ],
    ids=["titles", "padded", "descriptions", "all-at-once"],
)
def test_lines_that_are_no_part_of_the_table_are_to_be_declared(table, text, advice):
    with pytest.raises(UnreadableError, match=f"the table seems to .*{re.escape(advice)}"):
        _read(table, text)


def test_an_undecodable_byte_is_placed_and_a_byte_order_mark_tells_the_encoding(table):
    text = f"t,v,p\n{ROWS}".encode() + "0.3,79.5,Öl\n".encode("cp1252")
    told = r"line 5, byte 10: 0xd6 is not UTF-8; .* csv: \{encoding: cp1252\}"
    with pytest.raises(UnreadableError, match=told):
        _read(table, text)
    latin = Dialect(encoding="cp1252")
    assert _read(table, text, latin).channels["p"][-1] == "Öl"
    for encoding, mark in (
        ("utf-8-sig", ""),
        ("utf-16", ""),
        ("utf-16-le", "\ufeff"),
        ("utf-16-be", "\ufeff"),
    ):
        group = _read(table, f"{mark}t,v,Öl\n{ROWS}".encode(encoding), latin)
        assert list(group.channels) == ["t", "v", "Öl"]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"t,v,p\n" + ROWS.encode() + b"0.3,79,1,9\n", "line 5 has 4 cells, line 1 names 3 channels"),
        (b'"t,v,p\n' + ROWS.encode(), "line 1 has a quotation mark that is not closed"),
        (b't,v,p\n0.0,"80,1\n' + ROWS.encode(), "line 2 has a quotation mark that is not closed"),
        (b"t,v,p\n" + ROWS.encode() + b"\0\0,1,2\n", "line 5 holds a NUL character"),
        (b"t,v,p\n", "no line of samples follows the names in line 1"),
        (ROWS.encode(), "no line of names stands above the samples"),
        (b"\n \n", "every line is blank or a comment"),
        (b"# only a comment\n", "every line is blank or a comment"),
        (b"a" * 2_000_000, "a line of more than 1048576 characters"),
        (b"\x00" * 5000, "line 1 holds a NUL character"),
        (b"\xff\xfe" * 2000, "no line of samples follows the names in line 1"),
        (b"," * MOST_CHANNELS, f"line 1 has {MOST_CHANNELS + 1} cells"),
        (b"t,v\n" + b"," * 1_000_000 + b"\n1,2\n", "line 2 has 1000001 cells"),
        (b"t,v\n" + b"1,2\n" * 2000 + b"1," * 400_000, "line 2002 has 400001 cells"),
    ],
)
def test_a_damaged_table_is_refused_with_its_line(table, content, message):
    with pytest.raises(UnreadableError, match=re.escape(message)):
        _read(table, content)


def test_a_cell_that_holds_no_number_takes_no_other_with_it_and_is_placed(table):
    """Empty ones neither; four hundred digits are a number, and thousands where they are declared."""
    group = _read(table, "t,v,p\n0.0,#N/A,1\n0.1,80.0,2\n")
    np.testing.assert_array_equal(group.channels["v"], [np.nan, 80.0])
    np.testing.assert_array_equal(group.channels["p"], [1.0, 2.0])
    group = _read(table, "t,v\n0.0,80.5,\n# a remark, with commas,\n0.1,80.0,,\n,,,\n")
    assert [list(samples) for samples in group.channels.values()] == [[0.0, 0.1], [80.5, 80.0]]
    group = _read(table, "t,v,MV\n\n0.0,80.5,fill\n# remark\n\n0.1,n.a.,vent\n")
    assert group.first_texts["v"] == {"n.a.": "line 6, column 2"}
    assert group.first_texts["MV"] == {"fill": "line 3, column 3", "vent": "line 6, column 3"}
    group = _read(table, f"t,v\n0.0,{'9' * 400}\n0.1,off\n")
    assert group.first_texts == {"v": {"off": "line 3, column 2"}}
    group = _read(table, "t;v\n0,5;1.080,5\n", Dialect(";", ",", thousands="."))
    np.testing.assert_array_equal(group.channels["v"], [1080.5])
    group = _read(table, "Rig\nt;v\ns;km/h\n0,0;80,5\n", Dialect(";", ",", header_line=2))
    assert (group.units, list(group.channels["v"])) == ({"t": "s", "v": "km/h"}, [80.5])
