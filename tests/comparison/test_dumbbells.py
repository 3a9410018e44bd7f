"""Braking distances of both sides as rows: order, places, what is left out."""

import pytest

from uictest.analysis.comparison.dumbbells import MEASURE, MOST, dumbbells
from uictest.report import Difference


def _difference(case, first, second, quantity=MEASURE):
    return Difference(case, quantity, first, second, within=False)


def test_the_case_that_differs_most_stands_first_and_places_are_in_proportion():
    drawn = dumbbells([_difference("a", 400.0, 410.0), _difference("b", 500.0, 460.0)])
    assert drawn is not None
    assert [name for _, name in drawn.plot.y_ticks] == ["b", "a"]
    lines = [shape for shape in drawn.plot.shapes if shape.kind == "interval-line"]
    of_b, of_a = (float(each.path.split("H")[1]) - float(each.path[1:].split()[0]) for each in lines)
    assert of_b == pytest.approx(-4.0 * of_a, abs=0.5)
    assert lines[0].words == "b: 500 m, then 460 m (-40 m)"
    assert drawn.left_out == 0
    long = dumbbells([_difference("x" * 80, 1.0, 2.0)])
    assert long is not None
    assert len(long.plot.y_ticks[0][1]) == 40


def test_what_is_no_distance_of_both_sides_has_no_row():
    other = _difference("a", 1.0, 2.0, quantity="braking_time_s")
    assert dumbbells([other, _difference("b", "missing", 400.0), _difference("c", float("nan"), 1.0)]) is None


def test_of_many_cases_those_that_differ_most_are_drawn():
    drawn = dumbbells([_difference(str(k), 400.0, 401.0 + k) for k in range(MOST + 5)])
    assert drawn is not None
    assert (len(drawn.plot.y_ticks), drawn.left_out) == (MOST, 5)
    assert drawn.plot.y_ticks[0][1] == str(MOST + 4)
