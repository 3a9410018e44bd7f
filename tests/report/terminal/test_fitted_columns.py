import pytest
from hypothesis import given, strategies as st

from uictest.report.terminal.table_lines import (
    TableColumn,
    aligned,
    columns_not_shown,
    fitted,
    wrapped_name,
)

LONG = (
    "a-stop[rail.friction=0.10,brake.command=100 %,controller.slip_threshold=0.80,initial_speed=120 km-h,x=1]"
)


def _columns(*ids):
    rows = len(ids)
    return [
        TableColumn("case", ids, wraps=True),
        TableColumn("verdict", ["met"] * rows),
        TableColumn("distance", ["465.2"] * rows, rank=1, right=True),
        TableColumn("remark", ["largest at 12.3 s"] * rows, rank=2),
    ]


@pytest.mark.parametrize("width", [40, 60, 80, 100, 120, 200])
def test_a_table_keeps_to_the_width_and_names_are_complete(width):
    columns, _ = fitted(_columns("dry-120", LONG), width)
    lines = list(aligned(columns))
    assert max(map(len, lines)) <= width
    names = columns[0].cells
    assert "".join(line.strip() for line in names[1].split("\n")).replace(" ", "") == LONG.replace(" ", "")


def test_what_matters_least_gives_way_first_and_is_named_and_nothing_without_a_width():
    columns, given_way = fitted(_columns(LONG * 3), None)
    assert (len(columns), given_way) == (4, [])
    assert LONG * 3 in "\n".join(aligned(columns))
    assert fitted(_columns("dry-120"), 60)[1] == []
    shown, given_way = fitted(_columns("dry-120"), 30)
    assert [column.title for column in shown] == ["case", "verdict", "distance"]
    assert columns_not_shown(given_way, "see x.csv") == "not shown for lack of room: remark; see x.csv"
    shown, given_way = fitted(_columns("dry-120"), 20)
    assert [column.title for column in shown] == ["case", "verdict"]
    assert [column.title for column in given_way] == ["distance", "remark"]


def test_a_name_is_broken_between_its_words():
    name = "slide-80[compensation=hysteresis]"
    assert wrapped_name(name, 22) == ["slide-80[compensation=", "hysteresis]"]
    assert wrapped_name(name, 20) == ["slide-80", "[compensation=", "hysteresis]"]
    assert wrapped_name("wet-80-command[command=100]", 14) == ["wet-80-command", "[command=100]"]


@given(st.text("ab0[]=,-_ .", max_size=60), st.integers(1, 30))
def test_a_wrapped_name_keeps_every_character_and_the_width(name, width):
    lines = wrapped_name(name, width)
    assert "".join(lines).replace(" ", "") == name.replace(" ", "")
    assert max(map(len, lines)) <= width
