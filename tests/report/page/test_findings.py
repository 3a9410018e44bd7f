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
        (_failing("slides", expect="fail"), ["All as expected"], "locked-wheels"),
        (make_result(expect="fail"), ["unexpected pass", "Expected: fail"], "All as expected"),
        (_BROKEN, ["the FMU stopped"], "All as expected"),
    ],
    ids=["fails-as-expected", "unexpected-pass", "error"],
)
def test_a_finding_is_what_is_not_as_expected(result, said, not_said):
    first = _first(page_html(make_content(result)))
    assert [words for words in said if words not in first] == []
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


@pytest.mark.parametrize(
    ("typed", "kept"),
    [
        ("scenarios -k slip -n 2 -o out --record all", ""),
        ("--set rail.friction=0.09 --seed 3 -x", "--set rail.friction=0.09 --seed 3 "),
        (
            "--seed=3 --repeat 5 --trust more -q --in-process",
            "--seed=3 --repeat 5 --trust more --in-process ",
        ),
    ],
)
def test_what_changes_a_case_is_kept_and_nothing_else(typed, kept):
    manifest = RunManifest(command=("uictest", "run", *typed.split()))
    assert rerun_command(manifest, "a/slip.yaml", "slip") == f"uictest run a/slip.yaml {kept}-k slip"


@pytest.mark.parametrize("command", [("evaluate", "a.csv"), (), ("run", CASES_IN_PYTHON, "a.yaml")])
def test_recorded_stops_and_cases_that_a_program_may_have_changed_have_no_such_command(command):
    assert rerun_command(RunManifest(command=("uictest", *command)), "a.yaml", "a") == ""


def test_what_the_shell_would_read_is_quoted_and_a_file_like_an_option_is_still_a_file():
    manifest = RunManifest(command=("uictest", "run", "--seed", "3", "--", "-x.yaml"))
    assert rerun_command(manifest, "-x.yaml", "x") == "uictest run ./-x.yaml --seed 3 -k x"
    manifest = RunManifest(command=("uictest", "run", "--set", "rail.friction=0.08, 0.09"))
    command = rerun_command(manifest, "my stops.yaml", "slip[friction=0.08]; rm x")
    assert command == (
        "uictest run 'my stops.yaml' --set 'rail.friction=0.08, 0.09' -k 'slip[friction=0.08]; rm x'"
    )
