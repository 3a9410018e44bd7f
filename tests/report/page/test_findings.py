"""What a page answers first: what is not as expected, by how much and where, and what runs it again."""

import re
from dataclasses import replace

import pytest

from uictest.judging.evaluation import AppliedDefinition
from uictest.report import CASES_IN_PYTHON, RunManifest
from uictest.report.case_lines import MOST_CLOSE, NARROW, TITLE
from uictest.report.content import CaseDescription
from uictest.report.page.findings import rerun_command
from uictest.report.page.margins import margins_of
from uictest.report.page.run_page import page_html
from uictest.report.traces.trace import trace_of

from ..builders import make_content, make_recording, make_result, make_verdict

_SECONDS = {"unit": "s", "lower": None, "upper": 1.0, "status": "fail", "layer": "requirement"}
_LOCKED = make_verdict(id="locked-wheels", value=3.5, margin=-2.5, measure="longest_locked_time", **_SECONDS)


def _failing(case_id, *verdicts, **changes):
    return make_result(id=case_id, outcome="fail", criteria=verdicts or (_LOCKED,), **changes)


def _text(html):
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", html))


def _first(html):
    """Return what stands above the table of cases."""
    return _text(html[html.index("<main") : html.index('id="verdicts"')])


def test_what_failed_stands_first_with_value_limit_and_margin():
    html = page_html(make_content(make_result(id="fine"), _failing("slides", _LOCKED, make_verdict())))
    said = _first(html)
    assert "Not as expected" in said
    assert "locked-wheels 3.5 s, upper limit 1 s, margin -2.5 s (-250 %)" in said
    assert 'href="#case-slides"' in html[: html.index('id="verdicts"')]
    findings = said.partition(TITLE)[0]
    assert "fine" not in findings
    assert "braking-distance" not in findings  # a criterion that passes is no reason for a failure


_BROKEN = make_result(outcome="error", criteria=(), measures=None, wheelsets=(), reason="the FMU stopped")


@pytest.mark.parametrize(
    ("result", "said", "not_said"),
    [
        (_failing("slides", expect="fail"), "All as expected", "locked-wheels"),
        (make_result(expect="fail"), "unexpected pass", "All as expected"),
        (make_result(expect="fail"), "Expected: fail", "All as expected"),
        (_BROKEN, "the FMU stopped", "All as expected"),
    ],
)
def test_a_finding_is_what_is_not_as_expected(result, said, not_said):
    first = _first(page_html(make_content(result)))
    assert said in first
    assert not_said not in first


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


def test_where_all_is_well_the_least_to_spare_is_named_and_what_is_close_with_a_link_and_a_count():
    nearest = make_verdict(value=540.0, lower=400.0, upper=600.0, margin=60.0)
    wide = make_verdict(value=500.0, lower=400.0, upper=600.0, margin=100.0)
    cases = [make_result(id="wide", criteria=(wide,)), make_result(id="nearest", criteria=(nearest,))]
    said = _first(page_html(make_content(*cases)))
    assert "All as expected. Least to spare: nearest" in said
    assert "540 m, 400 .. 600 m, margin 60 m (+10 %)" in said
    assert TITLE not in said
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


_AT_NARROW = 490.0 * NARROW / 100
_NONE = {"value": None, "margin": None}


@pytest.mark.parametrize(
    ("changes", "kind"),
    [
        ({"margin": _AT_NARROW - 0.1}, "narrow"),
        ({"margin": _AT_NARROW + 0.1}, "pass"),
        ({"margin": -1.0, "status": "fail"}, "fail"),
        ({"status": "inconclusive", **_NONE}, "inconclusive"),
        ({"status": "not_applicable", **_NONE}, "not-judged"),
    ],
)
def test_a_cell_of_the_matrix_is_shaped_by_its_margin(changes, kind):
    margins = margins_of([make_verdict(**changes)])
    assert [margin.kind for margin in (*margins.judged, *margins.not_applicable)] == [kind]


def test_every_case_has_a_cell_for_every_criterion_and_what_has_no_room_is_counted():
    idle = make_verdict(id="idle", status="not_applicable", value=None, margin=None)
    html = page_html(make_content(make_result(id="a", criteria=(idle,)), make_result(id="b")))
    # What does not apply is told from what a case is not judged by.
    cells = re.findall(r'<td class="number criterion[^>]*>([^<]*)</td>', html)
    assert cells == ["+5.05", "–", "–", "n/a"]  # noqa: RUF001 - dashes on paper
    many = [make_verdict(id=f"criterion-{n:02}") for n in range(12)]
    missed = make_verdict(id="zz-missed", margin=-5.0, status="fail")
    html = page_html(make_content(_failing("a", *many, missed), make_result(id="b", criteria=(many[0],))))
    table = html[html.index('<table class="verdicts') :]
    assert "3 more criteria in criteria.csv" in _text(table)
    assert "zz-missed" in table[: table.index("</thead>")]
    rows = re.findall(r"<tr [^>]*data-word.*?</tr>", table, re.S)
    assert [row.count("number criterion") for row in rows] == [10, 10]
    # Many findings are counted, and none is lost.
    html = page_html(make_content(*(_failing(f"case-{n:02}") for n in range(15))))
    assert "3 more stand below" in _first(html)
    assert len(re.findall(r"<tr [^>]*data-word=\"fail\"", html)) == 15


@pytest.mark.parametrize(
    ("command", "file", "case_id", "again"),
    [
        # What changes a case is kept, and nothing else.
        ("run scenarios -k slip -n 2 -o out --record all", "a/slip.yaml", "slip", "a/slip.yaml -k slip"),
        ("run --set rail.friction=0.09 --seed 3 -x", "a/slip.yaml", "slip",
         "a/slip.yaml --set rail.friction=0.09 --seed 3 -k slip"),
        ("run --seed=3 --repeat 5 --trust more -q --in-process", "a/slip.yaml", "slip",
         "a/slip.yaml --seed=3 --repeat 5 --trust more --in-process -k slip"),
        # Recorded stops, and cases that a program may have changed, have no such command.
        ("evaluate a.csv", "a.yaml", "a", ""),
        ("", "a.yaml", "a", ""),
        (("run", CASES_IN_PYTHON, "a.yaml"), "a.yaml", "a", ""),
        # What the shell would read is quoted, and a file like an option is still a file.
        ("run --seed 3 -- -x.yaml", "-x.yaml", "x", "./-x.yaml --seed 3 -k x"),
        (("run", "--set", "rail.friction=0.08, 0.09"), "my stops.yaml", "slip[friction=0.08]; rm x",
         "'my stops.yaml' --set 'rail.friction=0.08, 0.09' -k 'slip[friction=0.08]; rm x'"),
    ],
)  # fmt: skip
def test_the_command_that_runs_a_case_again(command, file, case_id, again):
    words = command.split() if isinstance(command, str) else command
    found = rerun_command(RunManifest(command=("uictest", *words)), file, case_id)
    assert found == (f"uictest run {again}" if again else "")
