"""Tables as HTML for a notebook: every text is one, whatever it holds."""

from xml.etree import ElementTree

import pytest

from uictest.report.formats.html import html_table
from uictest.report.words import printable

from .made_up import ROWS, TABLE, TEXTS, table_of_texts


def test_a_table_has_its_headings_its_rows_and_colours():
    head, body = ElementTree.fromstring(html_table(TABLE))
    headings = [cell.text for cell in head.iter("th")]
    assert headings == ["case", "verdict", "distance, m", "vents", "met", "energy, kJ", "why"]
    rows = [[cell.text or "" for cell in row] for row in body]
    assert rows[1] == ["wet-80", "fail", "-", "0", "no", "0", "wheelset 2 stands"]
    assert len(rows) == len(ROWS)
    assert [row[1].get("style") for row in body] == ["color:#1a7f37", "color:#cf222e", "color:#1a7f37"]


@pytest.mark.parametrize("text", TEXTS)
def test_no_text_is_markup(text):
    _, body = ElementTree.fromstring(html_table(table_of_texts([text])))
    assert [cell.text or "" for row in body for cell in row] == [printable(text)] * 2 if text else True
