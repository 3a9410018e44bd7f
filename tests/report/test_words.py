"""Texts made harmless, counts, quantities, and the word of an outcome."""

from typing import get_args
from xml.etree import ElementTree

import pytest
from hypothesis import given

from uictest.judging.evaluation.result import Outcome
from uictest.report.verdict_sentences import counts_text
from uictest.report.words import (
    CASE_WORDS,
    argument,
    counted,
    counted_in,
    csv_cell,
    line_word,
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
def test_printable_text_is_one_line_that_cannot_drive_a_terminal(text):
    assert printable(text).isprintable()


@given(ANY_TEXT)
def test_whatever_the_text_xml_with_it_can_be_parsed(text):
    element = ElementTree.Element("failure", message=xml_text(text))
    element.text = xml_text(text)
    ElementTree.fromstring(ElementTree.tostring(element, encoding="utf-8"))


@given(ANY_TEXT)
def test_a_workflow_message_stays_one_command_and_its_properties_are_one_each(text):
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
        (number(465.2549), "465.25"),
        (number(1e-12), "1e-12"),
        (number(None) + number(float("nan")), "--"),
        (number(465.2549, 4), "465.3"),
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


def test_every_word_is_counted_and_is_one_field_of_a_line():
    counts = dict.fromkeys(CASE_WORDS, 1)
    assert len(counts_text(counts, 0).split(", ")) == len(CASE_WORDS)
    assert not any(" " in line_word(word) for word in CASE_WORDS)
    assert line_word("expected fail") == "expected-fail"
