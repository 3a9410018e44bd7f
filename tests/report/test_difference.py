import math

import pytest
from hypothesis import given, strategies as st

from uictest.report import relative_percent
from uictest.report.difference import (
    Difference,
    StatusChange,
    difference_sentences,
    relative_text,
    status_difference,
    turn,
    worst_of_wheelsets,
)


@pytest.mark.parametrize(
    ("first", "second", "unit", "text"),
    [
        (473.1, 478.17, "m", "+1.07"),
        (-2.0, -1.0, "m/s2", "+50"),
        (-2.0, -3.0, "m/s2", "-50"),
        (4.0, 0.0, "bar", "-100"),
        (0.0, 1.0, "bar", "A is 0"),
        (0.0, math.nan, "bar", "A is 0"),
        (1.0, math.nan, "bar", "-"),
        (20.0, 30.0, "degC", "-"),
        ("pass", "fail", "", "-"),
        ("none", 1.0, "", "-"),
        (1.0, 10.994, "m", "+999"),
        (0.001, 1.0, "km/h", "> 1000"),
        (0.001, -1.0, "km/h", "< -1000"),
    ],
)
def test_a_relative_figure_is_per_cent_of_the_size_of_a(first, second, unit, text):
    assert relative_text(first, second, unit) == text


@given(st.floats(1e-3, 1e6), st.floats(-1e6, 1e6), st.sampled_from([-1.0, 1.0]))
def test_a_relative_figure_gives_the_second_side_back(size, second, sign):
    percent = relative_percent(sign * size, second)
    assert percent is not None
    assert sign * size + percent / 100.0 * size == pytest.approx(second, rel=1e-9, abs=1e-6 * size)
    assert math.copysign(1.0, percent) == math.copysign(1.0, second - sign * size)


def test_the_trains_own_measure_is_no_wheelset_of_the_measure_of_the_same_name():
    names = ["adhesion_utilisation", *(f"adhesion_utilisation_{n}" for n in range(1, 5))]
    differences = [
        Difference("case", name, 0.8, 0.7, within=False, deviation=0.1 + place, allowed=0.01)
        for place, name in enumerate(names)
    ]
    train, wheelsets = worst_of_wheelsets(differences)
    assert (train.quantity, train.remark) == ("adhesion_utilisation", "")
    assert (wheelsets.quantity, wheelsets.remark) == ("adhesion_utilisation_4", "worst of 4 wheelsets")


def test_of_many_differences_the_furthest_out_are_shown_and_the_others_counted():
    differences = [
        Difference("case", f"quantity-{n}", 1.0, 1.0 + n, within=False, deviation=float(n), allowed=0.5)
        for n in range(1, 31)
    ]
    lines = difference_sentences(differences, most=3)
    assert [line.split()[1] for line in lines[:3]] == ["quantity-30", "quantity-29", "quantity-28"]
    assert lines[3] == "baseline: 27 more quantities out of tolerance, in results.json"
    assert len(difference_sentences(differences)) == 30


@pytest.mark.parametrize(
    ("first", "second", "word"),
    [
        ("pass", "fail", "new"),
        ("skipped", "invalid", "new"),
        ("pass", "inconclusive", "new"),
        ("error", "pass", "fixed"),
        ("fail", "invalid", "turned"),
        ("not_applicable", "fail", "turned"),
        ("pass", "not_applicable", "turned"),
        (None, "fail", "turned"),
        ("skipped", "pass", "turned"),
    ],
)
def test_a_verdict_that_is_missed_on_one_side_alone_is_new_or_fixed(first, second, word):
    found = status_difference("case", StatusChange(first, second, "locked-wheels"))
    assert found is not None
    assert (found.quantity, turn(found)) == ("criterion locked-wheels", word)
    assert found.second == second.replace("_", " ")


def test_a_number_differs_or_is_within():
    assert [turn(Difference("", "speed", 1.0, 2.0, within)) for within in (False, True)] == [
        "differs",
        "within",
    ]
    assert status_difference("case", StatusChange("pass", "pass")) is None
