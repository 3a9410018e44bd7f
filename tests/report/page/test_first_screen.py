"""The first screen of a page: what is not as expected, by how much, when, why, where, what runs it again."""

import re
from dataclasses import replace
from itertools import product

import pytest

from uictest.judging.evaluation import AppliedDefinition
from uictest.report import CASES_IN_PYTHON, RunManifest
from uictest.report.case_lines import NARROW
from uictest.report.page.margins import margins_of
from uictest.report.page.run_page import page_html
from uictest.report.rerun import rerun_command
from uictest.report.summary import MOST_GROUPS, run_summary
from uictest.report.traces.trace import trace_of

from ..builders import make_content, make_recording, make_result, make_verdict
from ..made_up_series import MISSED

_SECONDS = {"unit": "s", "lower": None, "upper": 1.0, "status": "fail", "layer": "requirement"}
_LOCKED = make_verdict(id="locked-wheels", value=3.5, margin=-2.5, measure="longest_locked_time", **_SECONDS)


def _failing(case_id, *verdicts, **changes):
    return make_result(id=case_id, outcome="fail", criteria=verdicts or (_LOCKED,), **changes)


def _first(html):
    """Return what stands above the table of cases, with its elements."""
    return html[html.index("<header") : html.index('id="verdicts"')]


def _text(html):
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", html))


def test_what_failed_stands_first_with_value_limit_and_what_runs_it_again():
    content = make_content(
        make_result(id="fine"),
        _failing("slides", _LOCKED, make_verdict(), scenario="a.yaml"),
        manifest=RunManifest(command=("uictest", "run", "a.yaml")),
    )
    first = _first(page_html(content))
    said = _text(first)
    assert "1 of 2 cases failed: slides (locked-wheels)" in said
    assert "locked-wheels : 3.5 s (limit 1 s)" in said
    assert "uictest run a.yaml -k slides" in said
    assert 'href="#case-slides"' in first
    said = said.partition("Close or uncertain")[0]
    assert "fine" not in said
    assert "braking-distance" not in said  # a criterion that passes is no reason for a failure


_BROKEN = make_result(outcome="error", criteria=(), measures=None, wheelsets=(), reason="the FMU stopped")


@pytest.mark.parametrize(
    ("result", "said", "failed"),
    [
        (_failing("slides", expect="fail"), "1 expected fail", False),
        (make_result(expect="fail"), "should not have passed", True),
        (make_result(expect="fail"), "expected: fail", True),
        (_BROKEN, "the FMU stopped", True),
    ],
)
def test_a_group_is_what_is_not_as_expected(result, said, failed):
    first = _first(page_html(make_content(result)))
    assert said in _text(first)
    assert ('class="tally-bad"' in first, 'class="group' in first) == (failed, failed)


def test_of_several_wheelsets_the_worst_is_named_with_its_time_and_a_link_to_it():
    recording = make_recording()
    time = recording["time"]
    for n, last in ((2, 12.0), (4, 10.5)):
        recording.channels[f"wheel_speed_{n}"][(time > 10.0 + 1e-6) & (time < last + 1e-6)] = 0.0
    known = [AppliedDefinition(name, 0.1, "m/s", "chosen") for name in ("locked_speed", "moving_speed")]
    of_all = {"definition": {"wheelsets": "all"}, "definitions": tuple(known), "missed_by": (2, 4)}
    locked = replace(_LOCKED, measure="longest_lock", value=2.0, **of_all)
    html = page_html(
        make_content(_failing("slides", locked), traces={"slides": trace_of(recording, [locked])})
    )
    found = re.search(r'<a href="#case-slides" data-criterion="locked-wheels">([^<]*)</a>', _first(html))
    assert found[1] == "2 s (limit 1 s), wheelset 2, 10 to 12 s"
    # The viewer says which wheelsets miss it, and what the WSP did.
    stop = _text(html[html.index('id="stops"') :])
    assert "2 s (limit 1 s), wheelsets 2 and 4" in stop
    assert "vents while rolling" in stop


def _swept(failing):
    return [
        make_result(
            id=f"slip[friction={friction},command={command}]",
            scenario="slip.yaml",
            parameters={"rail.friction": friction, "brake.command": command},
            **({"outcome": "fail", "criteria": (_LOCKED,)} if (friction, command) in failing else {}),
        )
        for friction, command in product(("0.06", "0.08"), ("60 %", "80 %"))
    ]


def test_cases_that_fail_alike_are_one_block_with_the_map_of_their_parameters_beside_it():
    cases = _swept({("0.06", "60 %"), ("0.06", "80 %")})
    first = _first(page_html(make_content(*cases)))
    assert first.count('<section class="group') == 1
    assert "2 cases miss requirements: friction 0.06" in _text(first)
    beside = first[first.index('<table class="map">') : first.index("</table>")]
    assert re.findall(r'class="cell outcome-(\w+)', beside) == ["fail", "fail", "pass", "pass"]
    assert beside.count('<a href="#case-slip') == 4
    # Without a failure the map stands below the table.
    html = page_html(make_content(*_swept(set())))
    assert 'class="map"' not in _first(html)
    assert html.count('<table class="map">') == 1


def test_of_a_check_the_reason_says_what_to_do_where_its_number_would_not():
    fits = {"id": "compensation-fits", "layer": "rig", "status": "fail", "value": 255.3, "margin": -254.3}
    check = make_verdict(**fits, reason="the compensation is for 0.01824 m2; write `identify`")
    said = _text(_first(page_html(make_content(make_result(outcome="invalid", criteria=(check,))))))
    assert "compensation-fits : the compensation is for 0.01824 m2; write `identify`" in said
    assert "255.3" not in said


def test_a_series_that_is_missed_is_a_group_with_a_line_for_each_criterion():
    html = page_html(make_content(make_result(), series=[MISSED]))
    first = _first(html)
    assert f"1 of 1 series is not as expected: {MISSED.id}" in _text(first)
    missed = [judged.verdict.id for judged in MISSED.criteria if judged.verdict.status == "fail"]
    group = first[first.index('<section class="group') : first.index("</section>")]
    assert [line.partition(":")[0] for line in re.findall(r"<li>(.*?)</li>", group)] == missed
    assert f'href="#series-{MISSED.id}"' in group


def test_what_is_close_is_said_once_for_each_criterion():
    cases = [
        make_result(id=f"close-{n:02}", criteria=(make_verdict(value=441.0 + n, margin=1.0 + n),))
        for n in range(10)
    ]
    first = _first(page_html(make_content(*cases)))
    assert "braking-distance 441 m (440 to 490 m), 0.2 % to spare, and 9 more cases" in _text(first)
    assert first.count('<li class="shape shape-narrow"><a href="#case-close-00" data-criterion=') == 1


def test_of_many_groups_the_rest_is_counted_and_every_case_has_a_row():
    cases = [_failing(f"case-{n:02}", replace(_LOCKED, id=f"criterion-{n}")) for n in range(MOST_GROUPS + 3)]
    html = page_html(make_content(*cases))
    assert _first(html).count('<section class="group') == MOST_GROUPS
    assert "3 more are not as expected: case-06, case-07, case-08" in _text(_first(html))
    assert len(run_summary(make_content(*cases)).blocks) == MOST_GROUPS + 1
    assert len(re.findall(r"<tr [^>]*data-word=\"fail\"", html)) == MOST_GROUPS + 3


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
    # What only says yes, and does so in every case, has no column.
    stands = make_verdict(id="stands", lower=1.0, upper=None, value=1.0, margin=0.0)
    html = page_html(make_content(make_result(criteria=(stands, make_verdict()))))
    assert re.findall(r'class="number criterion">([^<]*)</th>', html) == ["braking-distance"]


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"value": 61.8, "margin": -60.8, "lower": None, "upper": 1.0}, "61.8 × limit"),  # noqa: RUF001 - as the page says
        ({"value": 1.5, "margin": -0.5, "lower": None, "upper": 1.0}, "-50 %"),
        ({"value": 0.0, "margin": -35.0, "lower": 35.0, "upper": None}, "-100 %"),
    ],
)
def test_no_margin_is_said_in_thousands_of_per_cent(changes, text):
    (margin,) = margins_of([make_verdict(status="fail", **changes)]).judged
    assert margin.share_text == text


@pytest.mark.parametrize(
    ("command", "file", "case_id", "again"),
    [
        # What changes a case is kept, and nothing else.
        ("run scenarios -k slip -n 2 -o out --record all", "a/slip.yaml", "slip", "a/slip.yaml -k slip"),
        ("run --set rail.friction=0.09 --seed 3 -x", "a/slip.yaml", "slip",
         "a/slip.yaml --set rail.friction=0.09 --seed 3 -k slip"),
        ("run --seed=3 --repeat 5 --trust more -q --in-process --real-time --firm --strict", "a/slip.yaml",
         "slip",
         "a/slip.yaml --seed=3 --repeat 5 --trust more --in-process --real-time --firm --strict -k slip"),
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
    content = make_content(manifest=RunManifest(command=("uictest", *words)))
    assert rerun_command(content, file, case_id) == (f"uictest run {again}" if again else "")


def test_the_command_runs_no_case_whose_id_only_begins_alike():
    results = [make_result(id=name, scenario="p.yaml") for name in ("p.wet", "p.wet-soap", "p.dry")]
    content = make_content(*results, manifest=RunManifest(command=("uictest", "run", "p.yaml")))
    assert rerun_command(content, "p.yaml", "p.wet").endswith(" -k 'p.wet and not p.wet-soap'")
    assert rerun_command(content, "p.yaml", "p.dry").endswith(" -k p.dry")
