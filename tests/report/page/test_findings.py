"""What a page answers first: what is not as expected, by how much and where."""

import re
from dataclasses import replace

from uictest.judging.evaluation import AppliedDefinition
from uictest.report.close_calls import MOST_CLOSE, NARROW, TITLE
from uictest.report.content import CaseDescription
from uictest.report.page.run_page import page_html
from uictest.report.page.stop.margins import margins_of
from uictest.report.traces.trace import trace_of

from ..builders import make_content, make_recording, make_result, make_verdict

_LOCKED = make_verdict(
    id="locked-wheels",
    layer="requirement",
    value=3.5,
    unit="s",
    lower=None,
    upper=1.0,
    margin=-2.5,
    status="fail",
    measure="longest_locked_time",
)


def _failing(case_id, *verdicts, **changes):
    return make_result(id=case_id, outcome="fail", criteria=verdicts or (_LOCKED,), **changes)


def _text(html):
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", html))


def _first(html):
    """Return what stands above the table of cases."""
    return _text(html[html.index("<main") : html.index('id="verdicts"')])


def test_what_failed_stands_first_with_value_limit_and_margin():
    html = page_html(make_content(make_result(id="fine"), _failing("slides")))
    said = _first(html)
    assert "Not as expected" in said
    assert "locked-wheels 3.5 s, upper limit 1 s, margin -2.5 s (-250 %)" in said
    assert 'href="#case-slides"' in html[: html.index('id="verdicts"')]
    assert "fine" not in said.partition(TITLE)[0]


def test_a_criterion_that_passes_is_no_reason_for_a_failure():
    said = _first(page_html(make_content(_failing("slides", _LOCKED, make_verdict()))))
    assert "braking-distance" not in said.partition(TITLE)[0]


def test_a_case_that_fails_as_expected_is_no_finding():
    said = _first(page_html(make_content(_failing("slides", expect="fail"))))
    assert "All as expected" in said
    assert "locked-wheels" not in said


def test_an_unexpected_pass_says_what_was_expected():
    said = _first(page_html(make_content(make_result(expect="fail"))))
    assert "unexpected pass" in said
    assert "Expected: fail" in said


def test_a_finding_states_its_conditions_and_of_several_wheelsets_the_worst():
    recording = make_recording()
    time = recording["time"]
    for n, last in ((2, 12.0), (4, 10.5)):
        recording.channels[f"wheel_speed_{n}"][(time > 10.0 + 1e-6) & (time < last + 1e-6)] = 0.0
    known = [AppliedDefinition(name, 0.1, "m/s", "chosen") for name in ("locked_speed", "moving_speed")]
    of_all = {"definition": {"wheelsets": "all"}, "definitions": tuple(known), "missed_by": (2, 4)}
    locked = replace(_LOCKED, measure="longest_lock", value=2.0, **of_all)
    settings = {"vehicle": "intercity-180", "initial speed": "120 km/h", "rail": "wet, friction 0.09"}
    content = make_content(
        _failing("slides", locked),
        subjects={"slides": CaseDescription(settings=settings)},
        traces={"slides": trace_of(recording, [locked])},
    )
    said = _first(page_html(content))
    assert "initial speed 120 km/h; rail wet, friction 0.09; expected: pass" in said
    assert "wheelsets 2 and 4, worst: wheelset 2 at 10 to 12 s" in said


def test_an_error_shows_its_reason():
    broken = make_result(outcome="error", criteria=(), measures=None, wheelsets=(), reason="the FMU stopped")
    assert "the FMU stopped" in _first(page_html(make_content(broken)))


def test_where_all_is_well_the_criterion_with_the_least_to_spare_is_named():
    nearest = make_verdict(value=540.0, lower=400.0, upper=600.0, margin=60.0)
    wide = make_verdict(value=500.0, lower=400.0, upper=600.0, margin=100.0)
    cases = [make_result(id="wide", criteria=(wide,)), make_result(id="nearest", criteria=(nearest,))]
    said = _first(page_html(make_content(*cases)))
    assert "All as expected. Least to spare: nearest" in said
    assert "540 m, 400 .. 600 m, margin 60 m (+10 %)" in said
    assert TITLE not in said


def test_what_is_close_or_uncertain_is_named_with_a_link_and_the_rest_is_counted():
    cases = [
        make_result(id=f"close-{n:02}", criteria=(make_verdict(value=441.0 + n, margin=1.0 + n),))
        for n in range(MOST_CLOSE + 2)
    ]
    html = page_html(make_content(*cases))
    said = _first(html)
    assert "close-00 : braking-distance 441 m, 440 .. 490 m (+0.204 %)" in said
    assert re.search(r'<li class="shape shape-narrow"><a href="#case-close-00">', html)
    assert "2 more are marked below" in said
    assert "Least to spare" not in said


def test_many_findings_are_counted_and_none_is_lost():
    html = page_html(make_content(*(_failing(f"case-{n:02}") for n in range(15))))
    assert "3 more stand below" in _first(html)
    assert len(re.findall(r"<tr [^>]*data-word=\"fail\"", html)) == 15


def test_a_cell_of_the_matrix_is_shaped_by_its_margin():
    def kind(**changes):
        own = margins_of([make_verdict(**changes)])
        return (*own.judged, *own.not_applicable)[0].kind

    assert kind(margin=490.0 * NARROW / 100 - 0.1) == "narrow"
    assert kind(margin=490.0 * NARROW / 100 + 0.1) == "pass"
    assert kind(margin=-1.0, status="fail") == "fail"
    assert kind(status="inconclusive", value=None, margin=None) == "inconclusive"
    assert kind(status="not_applicable", value=None, margin=None) == "not-judged"


def test_what_does_not_apply_is_told_from_what_a_case_is_not_judged_by():
    idle = make_verdict(id="idle", status="not_applicable", value=None, margin=None)
    html = page_html(make_content(make_result(id="a", criteria=(idle,)), make_result(id="b")))
    cells = re.findall(r'<td class="number criterion[^>]*>([^<]*)</td>', html)
    assert cells == ["+5.05", "–", "–", "n/a"]  # noqa: RUF001 - dashes on paper


def test_every_case_has_a_cell_for_every_criterion_and_what_has_no_room_is_counted():
    many = [make_verdict(id=f"criterion-{n:02}") for n in range(12)]
    missed = make_verdict(id="zz-missed", margin=-5.0, status="fail")
    html = page_html(make_content(_failing("a", *many, missed), make_result(id="b", criteria=(many[0],))))
    table = html[html.index('<table class="verdicts') :]
    assert "3 more criteria in criteria.csv" in _text(table)
    assert "zz-missed" in table[: table.index("</thead>")]
    rows = re.findall(r"<tr [^>]*data-word.*?</tr>", table, re.S)
    assert [row.count("number criterion") for row in rows] == [10, 10]
