import dataclasses

import numpy as np
import pytest

from uictest.analysis.comparison import (
    Tolerances,
    compare_recordings,
    compare_runs,
    comparison_document,
    comparison_html,
    verdict_line,
)
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.report import RunContent, document_lines

from .conftest import make_recording, make_run

DEFAULT = Tolerances()
COMPARED = len(STOP_COLUMNS) + 2 * len(WHEELSET_COLUMNS) + 2
"""Figures of a stop with two wheelsets, its outcome and the verdict of a criterion."""
HOSTILE = "\x1b[31m=cmd() <b>x</b></script>\u202e"


def test_only_what_is_out_of_tolerance_is_shown_unless_asked():
    found = compare_runs(make_run(), make_run(braking_distance_m=470.0, braking_time_s=27.51), DEFAULT)
    heading, line = document_lines(comparison_document(found), None)
    assert heading.split() == [
        "verdict",
        "case",
        "quantity",
        "first",
        "second",
        "deviation",
        "allowed",
        "unit",
    ]
    assert line.split()[:5] == ["differs", "dry-120", "braking_distance_m", "465", "470"]
    rows = document_lines(comparison_document(found, every=True), None)
    assert [row.split()[0] for row in rows][1:] == ["differs", "within"]
    assert (
        verdict_line(found)
        == f"{COMPARED} quantities compared: 1 out of tolerance, 1 different within tolerance"
    )


@pytest.mark.parametrize("width", [40, 60, 80, 100, 120, 200])
def test_on_a_narrow_terminal_the_case_stands_above_its_figures(width):
    case_id = "wet-80-friction[friction=0.10,command=80]"
    changes = {"braking_distance_m": 470.0, "verdict": "fail"}
    found = compare_runs(make_run(case_id=case_id), make_run(case_id=case_id, **changes), DEFAULT)
    lines = list(document_lines(comparison_document(found), width))
    assert max(len(line) for line in lines if not line.startswith("not shown")) <= width
    assert case_id in "".join(line.strip() for line in lines[:2])
    assert any({"465", "470"} <= set(line.split()) for line in lines)
    hidden = [name for name in ("deviation", "allowed", "unit") if name not in "".join(lines[:3])]
    assert [name for name in hidden if name not in lines[-1]] == []


def test_nothing_is_shown_of_what_is_the_same():
    found = compare_runs(make_run(), make_run(), DEFAULT)
    assert list(document_lines(comparison_document(found, every=True), None)) == []
    assert verdict_line(found) == f"{COMPARED} quantities compared, no difference"


def test_hostile_names_of_channels_are_text_on_the_terminal_and_on_the_page():
    channels = {HOSTILE: np.zeros(101)}
    found = compare_recordings(
        make_recording(**channels), make_recording(**{HOSTILE: np.ones(101)}), (HOSTILE, HOSTILE), DEFAULT
    )
    shown = "\n".join(document_lines(comparison_document(found), None))
    html = comparison_html(found)
    for text in (shown, html):
        assert "\x1b" not in text
        assert "\u202e" not in text
    assert "<b>x</b>" in shown
    assert "<b>x" not in html
    assert "&lt;b&gt;x&lt;/b&gt;" in html


def test_the_worst_wheelset_stands_for_all_unless_every_one_is_asked_for():
    before, after = make_run(), make_run()
    slid = [{**after.results[0].wheelsets[0], "maximum_slide": slide} for slide in (0.3, 0.4)]
    after = RunContent("after", [dataclasses.replace(after.results[0], wheelsets=tuple(slid))])
    found = compare_runs(before, after, DEFAULT)

    def differing(**options):
        lines = document_lines(comparison_document(found, **options), None)
        return [line.split() for line in lines if line.startswith("differs")]

    (row,) = differing()
    assert row[2:5] == ["maximum_slide_2", "0.02", "0.4"]
    assert row[7:] == ["1", "worst", "of", "2", "wheelsets"]
    assert [row[2] for row in differing(every=True)] == ["maximum_slide_1", "maximum_slide_2"]
