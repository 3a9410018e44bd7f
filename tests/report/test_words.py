"""Texts, numbers and differences as people and programs read them."""

import math
from dataclasses import replace
from typing import get_args
from xml.etree import ElementTree

import pytest
from hypothesis import given, strategies as st

from uictest.judging.evaluation.result import Outcome
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
from uictest.report.verdict_sentences import counts_text
from uictest.report.words import (
    CASE_WORDS,
    argument,
    counted,
    counted_in,
    csv_cell,
    listed,
    measure_heading,
    measure_words,
    no_command,
    number,
    percent,
    printable,
    quantity,
    result_word,
    tone,
    workflow_message,
    workflow_property,
    xml_text,
)

from .builders import make_result
from .formats.made_up import ANY_TEXT, TEXTS


@given(ANY_TEXT)
def test_no_text_drives_a_terminal_breaks_xml_or_begins_a_workflow_command_of_its_own(text):
    assert printable(text).isprintable()
    element = ElementTree.Element("failure", message=xml_text(text))
    element.text = xml_text(text)
    ElementTree.fromstring(ElementTree.tostring(element, encoding="utf-8"))
    assert not set(workflow_message(text)) & set("\r\n")
    assert not set(workflow_property(text)) & set(",:\r\n")


FORMULAS = TEXTS[TEXTS.index("=1+1") : TEXTS.index("http://example.org")]
HARMLESS = ("90 %", "slip-120", "-5", "+0.5", "-1.5e-3", "", "-5 permille", "-0.05 bar", "-10 degC")


@pytest.mark.parametrize(
    ("shown", "text"),
    [
        (printable("a\x1b[2Jb\nc\u202ed\udcff"), r"a\x1b[2Jb\nc\u202ed\udcff"),
        (printable("Bremsweg 465 m, größer, 제동 거리"), "Bremsweg 465 m, größer, 제동 거리"),
        *((csv_cell(formula)[0], "'") for formula in FORMULAS if formula != "{=A1}"),
        *((csv_cell(text), text) for text in HARMLESS),
        (workflow_message("100 %\nof it"), "100 %25%0Aof it"),
        (argument("-x y.yaml"), "'./-x y.yaml'"),
        (argument("a.yaml"), "a.yaml"),
        (no_command("  ::error::x"), "  \\x3a:error::x"),
        (no_command("::add-mask::x"), "\\x3a:add-mask::x"),
        (no_command("case ##[error]x"), "case #\\x23[error]x"),
        (no_command("  0.1  100 %"), "  0.1  100 %"),
        (counted(1, "case"), "1 case"),
        (counted(2, "quantity", "quantities"), "2 quantities"),
        (counted_in(2, 1), "2 cases, 1 series"),
        (counted_in(0, 1), "1 series"),
        (counted_in(0, 0), "0 cases"),
        (listed(["a", "b\n", "c"]), r"a, b\n, c"),
        (listed(list("abcde")), "a, b, c and 2 more"),
        (number(465.2549), "465.3"),
        (number(1e-12), "1e-12"),
        (number(None) + number(float("nan")), "--"),
        (number(465.2549, 6), "465.255"),
        (quantity(465.0, "m"), "465 m"),
        (quantity(0.0, "1"), "0"),
        (quantity(None, "m"), "-"),
        (percent(2 / 3), "66.67 %"),
        (percent(1.0, 3), "100 %"),
        (measure_heading("braking_distance_m"), ("braking distance", "m")),
        (measure_heading("maximum_slide_3"), ("maximum slide 3", "%")),
        (measure_heading("energy_residual"), ("energy residual", "")),
        (measure_heading("mean_deceleration_mps2"), ("mean deceleration", "m/s2")),
        (measure_heading("outcome"), ("outcome", "")),
        (measure_words("braking_distance_m"), "braking distance, m"),
        (measure_words("valve_actuations"), "valve actuations"),
    ],
)
def test_texts_and_numbers_as_people_read_them(shown, text):
    assert shown == text


@pytest.mark.parametrize(
    ("expect", "words"),
    [
        ("pass", ("pass", "fail", "invalid", "inconclusive", "error", "unexpected skip")),
        ("skipped", ("unexpected pass", "fail", "invalid", "inconclusive", "error", "skipped")),
        ("fail", ("unexpected pass", "expected fail", "invalid", "inconclusive", "error", "unexpected skip")),
        ("invalid", ("unexpected pass", "fail", "expected invalid", "inconclusive", "error",
         "unexpected skip")),
    ],
)  # fmt: skip
def test_the_word_of_a_case_says_outcome_and_expectation(expect, words):
    results = [make_result(outcome=outcome, expect=expect) for outcome in get_args(Outcome)]
    assert tuple(map(result_word, results)) == words
    # What is met looks good, and nothing else does.
    assert [tone(result_word(result)) == "good" for result in results] == [result.met for result in results]
    assert {word for word in words if tone(word) == "odd"} == {"error"}


def test_every_word_is_counted():
    counts = dict.fromkeys(CASE_WORDS, 1)
    assert len(counts_text(counts, 0).split(", ")) == len(CASE_WORDS)


@pytest.mark.parametrize(
    ("first", "second", "unit", "text"),
    [
        (473.1, 478.17, "m", "+1.07"),
        (-2.0, -1.0, "m/s2", "+50"),
        (-2.0, -3.0, "m/s2", "-50"),
        (4.0, 0.0, "bar", "-100"),
        (0.0, 1.0, "bar", "from 0"),
        (0.0, math.nan, "bar", "from 0"),
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


def test_of_many_differences_the_furthest_out_are_shown_and_of_wheelsets_the_worst():
    """The train's own measure is no wheelset of the measure of the same name."""
    sizes = {"adhesion_utilisation": 0.1, **{f"adhesion_utilisation_{n}": 0.1 + n for n in range(1, 5)}}
    differences = [
        Difference("case", name, 0.8, 0.7, within=False, deviation=size, allowed=0.01)
        for name, size in sizes.items()
    ]
    train, wheelsets = worst_of_wheelsets(differences)
    assert (train.quantity, train.remark) == ("adhesion_utilisation", "")
    assert (wheelsets.quantity, wheelsets.remark) == ("adhesion_utilisation_4", "worst of 4 wheelsets")
    many = [replace(train, quantity=f"quantity-{n}", deviation=float(n)) for n in range(1, 31)]
    *lines, last = difference_sentences(many, most=3)
    assert [line.split()[1] for line in lines] == ["quantity-30", "quantity-29", "quantity-28"]
    assert last == "baseline: 27 more quantities out of tolerance, in results.json"
    assert len(difference_sentences(many)) == 30


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
    assert status_difference("case", StatusChange(first, first)) is None
    numbers = [Difference("", "speed", 1.0, 2.0, within) for within in (False, True)]
    assert list(map(turn, numbers)) == ["differs", "within"]
