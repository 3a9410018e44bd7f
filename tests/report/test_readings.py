"""The readings of a criterion stand side by side in every report."""

import json

import pytest

from uictest.judging.evaluation import ReadVerdict, result_document
from uictest.report.formats.csv import criteria_table
from uictest.report.formats.md import markdown_summary
from uictest.report.page import page_html
from uictest.report.terminal.verdict_table import criterion_lines, definition_lines
from uictest.report.traces.trace import trace_of

from .builders import make_content, make_recording, make_result, make_verdict

SENTENCES = (
    "at-once (decides) pass: 42 % (down to 60 km/h) keeps > 35 %",
    "depth fail: 0 of 4 wheelsets keep > 35 % (above 30 km/h)",
)


@pytest.fixture
def read_result():
    """A case with a criterion that has two readings."""
    bounds = ("%", 35.0, None, 7.0)
    at_once, depth = (sentence.partition(": ")[2] for sentence in SENTENCES)
    origin = {"mark": "chosen", "source": "ours alone"}
    origin["definition"] = {"low_speed_cutoff": "30 km/h (chosen)"}
    readings = (
        ReadVerdict("at-once", True, "pass", "sliding_share", 42.0, *bounds, at_once),
        ReadVerdict("depth", False, "fail", "maximum_slide_above_cutoff", 14.9, *bounds, depth, **origin),
    )
    return make_result(criteria=(make_verdict(id="minimum-slide", readings=readings), make_verdict()))


def test_the_detail_on_a_terminal_has_every_reading_and_where_it_comes_from(read_result):
    lines = "\n".join([*criterion_lines(read_result), *definition_lines([read_result])])
    for sentence in SENTENCES:
        assert f"minimum-slide read as {sentence}" in lines
    expected = "minimum-slide read as depth: chosen: ours alone, low_speed_cutoff = 30 km/h (chosen)"
    assert f"definition {expected}" in lines


def test_tables_have_every_reading(read_result):
    with_readings, without = criteria_table([read_result]).rows
    assert with_readings["readings"] == "; ".join(SENTENCES)
    assert without["readings"] == ""


def test_the_page_and_the_summary_have_every_reading(read_result):
    content = make_content(read_result, traces={read_result.id: trace_of(make_recording())})
    for sentence in SENTENCES:
        escaped = sentence.replace(">", "&gt;")
        assert escaped in page_html(content)
        assert sentence.partition(": ")[0] in markdown_summary(content)
    assert "ours alone" in page_html(content)


def test_the_result_has_every_reading(read_result):
    document = json.loads(json.dumps(result_document([read_result])))
    with_readings, without = document["cases"][0]["criteria"]
    verdicts = {each["id"]: each["verdict"] for each in with_readings["readings"]}
    assert verdicts == {"at-once": "pass", "depth": "fail"}
    assert "readings" not in without
