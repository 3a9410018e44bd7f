from xml.etree import ElementTree

import pytest
from hypothesis import given, strategies as st

from uictest.report.escaping import (
    csv_cell,
    no_command,
    printable,
    workflow_message,
    workflow_property,
    xml_text,
)

any_text = st.text(st.characters(codec=None, exclude_categories=[]))


@given(any_text)
def test_printable_text_is_one_line_that_cannot_drive_a_terminal(text):
    assert printable(text).isprintable()


def test_printable_spells_out_what_it_takes_away_and_keeps_ordinary_text_of_any_script():
    assert printable("a\x1b[2Jb\nc\u202ed\udcff") == r"a\x1b[2Jb\nc\u202ed\udcff"
    assert printable("Bremsweg 465 m, größer, 제동 거리") == "Bremsweg 465 m, größer, 제동 거리"


@pytest.mark.parametrize(
    "text",
    [
        *("=1+1", "+A1", "-A1", "@SUM(A1)", "\t=1", "\r=1", " =1", "\uff1d1"),
        *("-5 A1", "-5 bar+A1", "-5 bar|x", "-5  bar", "-5 bar\n", "-5 -5", "-bar", "+1 furlong"),
    ],
)
def test_a_cell_never_begins_as_a_formula(text):
    assert csv_cell(text).startswith("'")


@pytest.mark.parametrize(
    "text", ["90 %", "slip-120", "-5", "+0.5", "-1.5e-3", "", "-5 permille", "-0.05 bar", "-10 degC"]
)
def test_text_numbers_and_quantities_are_left_as_they_are(text):
    assert csv_cell(text) == text


@given(any_text)
def test_whatever_the_text_xml_with_it_can_be_parsed(text):
    element = ElementTree.Element("failure", message=xml_text(text))
    element.text = xml_text(text)
    ElementTree.fromstring(ElementTree.tostring(element, encoding="utf-8"))


@given(any_text)
def test_a_workflow_message_stays_one_command_and_its_properties_are_one_each(text):
    assert not set(workflow_message(text)) & set("\r\n")
    assert not set(workflow_property(text)) & set(",:\r\n")
    assert workflow_message("100 %\nof it") == "100 %25%0Aof it"


@pytest.mark.parametrize(
    ("line", "shown"),
    [
        ("  ::error::x", "  \\x3a:error::x"),
        ("::add-mask::x", "\\x3a:add-mask::x"),
        ("case ##[error]x", "case #\\x23[error]x"),
        ("  0.1  100 %", "  0.1  100 %"),
        ("", ""),
    ],
)
def test_a_line_of_the_log_is_no_command(line, shown):
    assert no_command(line) == shown
