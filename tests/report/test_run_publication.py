"""The tables of a run for programs and people, its summary, and which of its cases are drawn."""

from dataclasses import replace

import pytest

from uictest.core.document import Lines
from uictest.judging.evaluation import Sensitivity, VerdictInterval
from uictest.report import CaseDescription, publication_of_run, publish
from uictest.report.content import DRAWN, MOST_DRAWN, drawn_cases, worst_first
from uictest.report.difference import BaselineComparison, Difference
from uictest.report.formats.text import table_lines
from uictest.report.run_publication import (
    cases_table,
    criteria_table,
    explained_cases_table,
    run_document,
    run_tables,
    wheelsets_table,
)

from .builders import HOSTILE, assert_as_csv, make_content, make_result, make_verdict
from .made_up_series import make_series
from .test_case_conditions import CHANGE, CONTROLLER
from .test_case_lines import STEPS, turning
from .test_robustness import make_repeated
from .test_verdict_sentences import READ

CRASHED = make_result(
    id="crashed", outcome="error", reason="ValueError: x", measures=None, wheelsets=(), criteria=()
)


def row(**changes):
    (record,) = cases_table(make_content(make_result(**changes))).records
    return record


def texts(*results, **changes):
    """Return what people read of the cases: heading -> texts."""
    table = cases_table(make_content(*results, **changes))
    return {column.title.replace("\n", " "): texts for column, texts in table.for_people}


def test_a_case_holds_parameters_as_written_figures_exactly_and_names_what_it_was_run_with():
    named = {"test_case": "TC-1", "requirements": ("BR-10", "BR-9"), "parts": {"controller": CONTROLLER}}
    record = row(parameters={"brake.command": "90 %", "expect": "fail"}, **named)
    assert (record["id"], record["parameters.brake.command"]) == ("dry-120[command=90]", "90 %")
    assert (record["energy_residual"], record["initial_adhesion_g"]) == (1e-8, None)
    # A parameter that is called like a column does not hide it.
    assert (record["parameters.expect"], record["expect"]) == ("fail", "pass")
    assert (record["outcome"], record["met"], record["test_validity"]) == ("pass", True, "valid")
    assert (record["controller"], record["controller_version"]) == ("threshold", "uictest 0.1.0")
    assert (record["changed_parameters"], record["test_case"]) == (CHANGE, "TC-1")
    assert record["requirements"] == "BR-10; BR-9"


def test_a_case_that_crashed_is_a_row_without_figures_and_cases_share_one_header():
    results = [make_result(parameters={"a.b": "1"}), replace(CRASHED, parameters={"c": "2"})]
    first, crashed = cases_table(make_content(*results)).records
    values = [(record["parameters.a.b"], record["parameters.c"]) for record in (first, crashed)]
    assert values == [("1", None), (None, "2")]
    assert (crashed["outcome"], crashed["met"], crashed["braking_distance_m"]) == ("error", False, None)
    assert len(wheelsets_table([CRASHED]).rows) == len(criteria_table([CRASHED]).rows) == 0
    vents = [(record["wheelset"], record["valve_actuations"]) for record in wheelsets_table(results).records]
    assert vents == [(n, n) for n in (1, 2, 3, 4)]


def test_every_criterion_is_a_row_with_its_definition_readings_and_requirements():
    absent = make_verdict(id="slide", value=None, margin=None, status="not_applicable")
    named = make_verdict(requirements=("BR-2", "BR-1"))
    distance, slide, read = criteria_table([make_result(criteria=(named, absent, READ))]).records
    assert [distance[key] for key in ("criterion", "value", "margin", "definition", "requirements")] == [
        *("braking-distance", 465.25, 24.75, "low_speed_cutoff = 30 km/h", "BR-2; BR-1")
    ]
    assert (slide["verdict"], slide["value"], slide["readings"]) == ("not_applicable", None, "")
    assert read["readings"] == "at-once (decides) pass: 42 % keeps > 35 %; depth fail: 0 of 4 wheelsets keep"


def test_people_read_verdict_statements_and_figures():
    shown = list(zip(*texts(make_result(), CRASHED).values(), strict=True))
    numbers = [column.is_number for column, _ in cases_table(make_content(make_result())).for_people]
    assert numbers == [False] * 4 + [True] * 9
    figures = ["465.2", "27.5", "1.195", "-", "-", "8.0", "0.0", "0.0", "4"]
    assert shown == [
        ("dry-120[command=90]", "pass", "yes", "-", *figures),
        ("crashed", "error", "-", "-", *("-" for _ in figures)),
    ]


@pytest.mark.parametrize("width", [60, 80, 100, 120, 200])
def test_figures_give_way_to_the_names_of_cases(width):
    ids = ["dry-120", "slide-80[compensation=hysteresis]", "wet-80-friction[friction=0.10]"]
    table = cases_table(make_content(*(make_result(id=case_id) for case_id in ids)))
    lines = list(table_lines(table, width))
    assert max(map(len, lines)) <= width
    column = "".join(line[: lines[0].index("verdict")].strip() for line in lines)
    assert [case_id for case_id in ids if case_id not in column] == []
    shown, _, left_out = " ".join(lines).partition("not shown for lack of room")
    assert not left_out or left_out.endswith("summary.csv has all")
    headings = [column.heading.split()[0].rstrip("-") for column, _ in table.for_people]
    assert [heading for heading in headings if (heading in shown) == (heading in left_out)] == []


def test_distance_and_columns_that_a_missed_criterion_rests_on_are_never_left_out_and_none_is_there_twice():
    locked = make_verdict(measure="locked_time", status="fail", unit="s", value=9.0)
    missed = cases_table(make_content(make_result(outcome="fail", criteria=(locked,))))
    assert "locked" in next(iter(table_lines(missed, 50)))
    for table, left_out in ((missed, "valid"), (cases_table(make_content(make_result())), "locked")):
        shown, _, not_shown = " ".join(table_lines(table, 50)).partition("not shown for lack of room")
        assert "distance" in shown
        assert left_out not in shown
        assert left_out in not_shown
    lock = make_verdict(id="locked-wheels", measure="longest_lock", status="fail", unit="s", value=109.66)
    results = make_result(id="a", outcome="fail", criteria=(lock,)), make_result(id="b", criteria=())
    assert texts(*results)["locked-wheels s"] == ["109.7", "-"]
    assert "locked-wheels s" not in texts(results[1])
    twice = replace(lock, id="longest"), replace(lock, id="of-distance", value=465.25)
    columns = list(texts(make_result(outcome="fail", criteria=(lock, *twice)), results[1]))
    assert [name for name in columns if name.startswith(("lock", "long", "of", "dist"))] == [
        *("distance m", "locked max s", "locked-wheels s")
    ]
    nothing = replace(lock, value=None, status="inconclusive")
    assert "locked-wheels s" not in texts(make_result(outcome="inconclusive", criteria=(nothing,)))


OUT = Difference("a", "braking_distance_m", 1.0, 2.0, False, "m", 1.0, 0.1)


@pytest.mark.parametrize(
    ("changes", "names"),
    [
        ({}, []),
        ({"results": [make_repeated("ppf")]}, ["repeats"]),
        ({"results": [make_result(requirements=("BR-1",))]}, ["requirements"]),
        ({"series": [make_series()]}, ["series", "series-criteria", "series-stops"]),
    ],
)
def test_a_run_has_three_tables_and_others_only_where_it_has_such(changes, names):
    content = make_content(**{"results": [make_result()]} | changes)
    assert [table.name for table in run_tables(content)] == ["summary", "wheelsets", "criteria", *names]


def test_a_summary_says_what_decides_first_and_cases_not_met_first():
    missed = make_result(
        id="b[x]", outcome="fail", criteria=(), reason="locked", parts={"controller": CONTROLLER}
    )
    baseline = BaselineComparison("base", "00", 5, 1, {"a": [OUT]}, not_run=("c",))
    close = make_result(id="c", criteria=(turning(90.0, *STEPS), READ), requirements=("BR-1",))
    more = {"baseline": baseline, "series": [make_series()], "passed_over": ["stop 3: no brake"]}
    content = make_content(make_result(id="a"), missed, close, **more, complete=False)
    document = run_document(content)
    assert document.title == "uictest: 1 of 3 cases failed: b; 1 differs from the baseline: a"
    assert document.about == [
        "Incomplete: not all that was selected was run.",
        "WSP controller: threshold (built into uictest 0.1.0).",
    ]
    failed, *sections = document.sections
    assert [block.heading for block in failed.blocks] == [
        "b[x] misses requirements",
        "a differs from the baseline",
    ]
    shown = [
        section.sentences[0] if isinstance(section, Lines) else section.for_people[0][1][0]
        for section in sections
        if (section.sentences if isinstance(section, Lines) else section.rows)
    ]
    assert shown == [
        *("acceptance: k-wet 0.8696 (0.8 needed), 8.7 % to spare", "acceptance"),
        "acceptance: Valid stops from 120 km/h: dry 2 of 2, wet 5 of 6 (83.33 %, 80 % needed)",
        "acceptance",
        "5 quantities compared with the baseline base: 1 out of tolerance, 1 different within tolerance",
        *("differs", "BR-1", "b[x]", "stop 3: no brake", "c"),
    ]
    table = explained_cases_table(make_content(make_result(id="a"), missed))
    columns = {column.heading: shown for column, shown in table.for_people}
    assert (columns["case"], columns["verdict"]) == (["b[x]", "a"], ["fail", "pass"])
    assert columns["changed parameters"] == [CHANGE, ""]
    assert columns["why"] == ["fail. Expected: pass; locked", ""]


@pytest.mark.parametrize(
    ("changes", "named"), [({}, False), ({"test_case": "TC-1"}, True), ({"requirements": ("BR-1",)}, True)]
)
def test_an_importer_finds_something_where_a_case_or_a_series_has_it(changes, named):
    for content in (
        make_content(make_result(**changes), subjects={"x": CaseDescription()}),
        make_content(series=[make_series(**changes)]),
    ):
        assert publication_of_run(content).named_in_tests == named


@pytest.mark.parametrize("text", ["slip", f"=1+1{HOSTILE}", "http://example.org"])
def test_the_workbook_of_a_run_holds_what_its_csv_files_hold(text, tmp_path):
    verdict = make_verdict(id=text, reason=text, definition={text: text}, requirements=("BR-1",))
    infinite = make_verdict(value=float("inf"), margin=None)
    result = make_result(
        id=text, parameters={text: text}, criteria=(verdict, infinite), reason=text, scenario=text
    )
    content = make_content(result, CRASHED, name=text, series=[make_series(id=text)])
    publish(publication_of_run(content), ["csv", "xlsx"], tmp_path)
    assert_as_csv(tmp_path)


def test_what_is_not_met_comes_first_requirements_before_tests_then_narrow_margins_and_verdicts_that_flip():
    intervals = (VerdictInterval(0.0, 0.5, "pass"), VerdictInterval(0.6, 1.0, "fail"))
    flips = Sensitivity("d", "s", 0.0, 1.0, intervals)
    requirement = make_verdict(status="fail", margin=-0.1, layer="requirement")
    validity = make_verdict(status="fail", margin=-90.0, layer="validity")
    results = [
        make_result(id="wide", criteria=(make_verdict(margin=200.0),)),
        make_result(id="narrow", criteria=(make_verdict(margin=2.0),)),
        make_result(id="flips", criteria=(make_verdict(margin=200.0, sensitivity=(flips,)),)),
        make_result(id="nothing", criteria=()),
        make_result(id="expected", outcome="fail", expect="fail"),
        make_result(id="no-test", outcome="invalid", criteria=(validity,)),
        make_result(id="missed", outcome="fail", criteria=(requirement,)),
    ]
    order = ["missed", "no-test", "expected", "flips", "narrow", "wide", "nothing"]
    assert [result.id for result in worst_first(results)] == order


def test_a_page_draws_from_every_scenario_in_turn():
    """A hundred narrow cases of one scenario leave room for the only one of another."""
    margins = [(make_verdict(margin=1.0 + n),) for n in range(100)]
    narrow = [make_result(id=f"a{n}", scenario="a.yaml", criteria=own) for n, own in enumerate(margins)]
    wide = make_result(id="b", scenario="b.yaml", criteria=(make_verdict(margin=200.0),))
    missed = [make_result(id=f"c{n}", scenario="c.yaml", outcome="fail") for n in range(2)]
    drawn = [result.id for result in drawn_cases([*narrow, wide, *missed])]
    assert len(drawn) == DRAWN
    assert drawn[:5] == ["c0", "c1", "a0", "b", "a1"]


def test_chosen_cases_are_drawn_before_all_others_more_if_more_are_chosen_and_not_without_end():
    results = [make_result(id=f"case-{n}", outcome="fail" if n < 50 else "pass") for n in range(100)]
    drawn = drawn_cases(results, {"case-98", "case-99"})
    assert [result.id for result in drawn[:2]] == ["case-98", "case-99"]
    assert len(drawn) == DRAWN
    assert len(drawn_cases(results, {f"case-{n}" for n in range(30)})) == 30
    assert len(drawn_cases(results, {result.id for result in results})) == MOST_DRAWN
