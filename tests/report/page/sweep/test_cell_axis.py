"""Where cells of a heat map lie."""

from itertools import pairwise

import pytest
from hypothesis import given, strategies as st
from pydantic import TypeAdapter

from uictest.report.page.sweep.cell_axis import placed_cells
from uictest.report.sweep.map_cells import CellAxis
from uictest.report.sweep.values import SweptValue

VALUE = TypeAdapter(SweptValue)


def placed(*texts, logarithmic=False, upright=False):
    axis = CellAxis("key", [(VALUE.validate_python(text),) for text in texts])
    return placed_cells(axis, ["key"] if logarithmic else [], 0.0, 300.0, upright=upright)


def test_evenly_spaced_numbers_have_cells_of_one_width():
    found = placed("60 km/h", "80 km/h", "100 km/h")
    assert (found.spacing, found.title) == ("linear", "key, km/h")
    assert found.edges == pytest.approx([0.0, 100.0, 200.0, 300.0])
    assert found.ticks == [
        (pytest.approx(50.0 + 100.0 * k), text) for k, text in enumerate(("60", "80", "100"))
    ]


def test_a_wider_step_has_a_wider_cell():
    found = placed("0", "1", "2", "4")
    # From -0.5 over 0.5, 1.5 and 3 to 5; a label stands where its number lies.
    assert found.edges == pytest.approx([300.0 * (at + 0.5) / 5.5 for at in (-0.5, 0.5, 1.5, 3.0, 5.0)])
    assert found.ticks == [(pytest.approx(300.0 * (n + 0.5) / 5.5), str(n)) for n in (0, 1, 2, 4)]


def test_decades_have_cells_of_one_width_on_a_logarithmic_axis():
    found = placed("0.01", "0.1", "1", "10", logarithmic=True)
    assert (found.spacing, found.title) == ("logarithmic", "key, logarithmic")
    assert found.edges == pytest.approx([0.0, 75.0, 150.0, 225.0, 300.0])


def test_intervals_end_where_their_numbers_do():
    intervals = ("1 .. 2", "2 .. 4", "4 .. 8")
    assert placed(*intervals).edges == pytest.approx([0.0, 300.0 / 7, 900.0 / 7, 300.0])
    assert placed(*intervals, logarithmic=True).edges == pytest.approx([0.0, 100.0, 200.0, 300.0])


@pytest.mark.parametrize(
    "texts",
    [("one", "four"), ("80 km/h", "20 m/s"), ("0.01", "0.02", "5"), ("0.2", "0.1", "0.3"), ("1", "1.0")],
)
def test_what_has_no_readable_scale_is_listed(texts):
    found = placed(*texts)
    assert found.spacing == "listed"
    assert found.edges == pytest.approx([300.0 * k / len(texts) for k in range(len(texts) + 1)])
    assert [label for _, label in found.ticks] == list(texts)
    upright = placed(*texts, upright=True)  # the first row stands on top
    assert upright.edges == pytest.approx([300.0 - edge for edge in found.edges])
    assert upright.span(0) == tuple(upright.edges[1::-1])


@given(st.lists(st.floats(1e-6, 1e6), min_size=2, max_size=60, unique=True), st.booleans())
def test_cells_touch_and_fill_the_axis(numbers, logarithmic):
    found = placed(*(repr(number) for number in sorted(numbers)), logarithmic=logarithmic)
    assert (min(found.edges), max(found.edges)) == pytest.approx((0.0, 300.0))
    assert all(before < after for before, after in pairwise(found.edges))
    assert len(found.edges) == len(numbers) + 1
    assert len(found.ticks) <= 17


def test_long_labels_of_narrow_cells_are_slanted_or_thinned():
    texts = [f"controller-{k}" for k in range(12)]
    assert placed(*texts).slanted
    assert not placed(*texts, upright=True).slanted
    numbers = placed(*(f"{1000 + k}" for k in range(60)))
    assert not numbers.slanted
    assert len(numbers.ticks) <= 10
