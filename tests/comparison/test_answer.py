"""Which of two sides is better: by numbers, by verdicts that turned, and what both sides are called."""

import math
from dataclasses import replace

import pytest

from uictest.analysis.comparison import Baseline, Scope, Tolerances, comparison_document
from uictest.analysis.comparison.answer import Answer, Condition, TurnedVerdict, subject_names
from uictest.analysis.comparison.comparison_document import conditions_table, differing_table
from uictest.analysis.comparison.paired_stops import PairedDifference
from uictest.analysis.comparison.parameters import ParameterChange
from uictest.analysis.comparison.runs import compare_runs
from uictest.core.measures import column_unit
from uictest.core.series_measures import mean_of
from uictest.judging.evaluation import EffectivePart, Parameter
from uictest.report import Difference, RunContent, RunManifest, StatusChange, document_lines

from ..report.builders import make_verdict
from .conftest import make_repeated, make_run

LOCKED = make_verdict(id="locked-wheels", layer="requirement", measure="locked_time", unit="s", value=0.5)


def _cases(shifts, requirement="pass", validity="pass"):
    """Nine repeated cases at three frictions and commands; each friction shifts their distances (m)."""
    cases = []
    for friction, shift in zip(("0.06", "0.08", "0.10"), shifts, strict=True):
        for command in ("60", "80", "100"):
            distances = {seed: 500.0 + seed + shift * (1.0 + 0.01 * seed) for seed in range(3)}
            case = make_repeated(
                distances, f"nine[friction={friction},command={command}]", friction + command
            )
            parameters = {"rail.friction": friction, "brake.command": command}
            criteria = replace(LOCKED, status=requirement), make_verdict(id="grip", status=validity)
            cases.append(replace(case, parameters=parameters, criteria=criteria))
    return cases


def _run(name, cases, version=""):
    facts = {"library": "wsp.so"} | ({"version": version} if version else {})
    rows = tuple(Parameter(f"controller.{key}", text, "", text, "user") for key, text in facts.items())
    part = EffectivePart("controller", "controller", "acme", None, rows)
    return RunContent(name, [replace(case, parts={"controller": part}) for case in cases])


def _answer(first, second):
    return compare_runs(_run("one", first, "3.1"), _run("other", second, "4.0"), Tolerances()).answer


def test_the_answer_names_versions_conditions_and_one_number_for_each_standing():
    answer = _answer(_cases((0.0, 0.0, 0.0)), _cases((-20.0, 0.0, 300.0)))
    assert answer.subjects == ("acme 3.1", "acme 4.0")
    assert answer.verdict == "acme 4.0 is better than 3.1 in 3 and worse in 3 of 9 conditions"
    better, worse, same, turned = answer.sentences
    assert better.startswith("acme 4.0 against 3.1: better in 3 of 9 conditions (friction 0.06): braking")
    assert better.endswith("distance 20.2 m shorter.")
    assert worse == "Worse in 3 (friction 0.10): 303 m longer."
    assert same == "No difference shown in 3 (friction 0.08)."
    assert turned == "No verdict turned."
    assert answer.basis.startswith("3 pairs of stops")
    assert [row.name for row in conditions_table(answer).rows][:1] == ["friction 0.10 at command 60"]


def test_nine_cases_take_forty_lines_of_a_hundred_columns():
    first, second = _cases((0.0, 0.0, 0.0)), _cases((-20.0, 0.0, 300.0), "fail")
    found = compare_runs(_run("one", first, "3.1"), _run("other", second, "4.0"), Tolerances())
    lines = list(document_lines(comparison_document(found), 100))
    assert len(lines) <= 40
    assert max(map(len, lines)) <= 100


def test_a_requirement_that_turned_decides_and_validity_is_told_apart():
    answer = _answer(_cases((0.0,) * 3), _cases((-20.0,) * 3, requirement="fail", validity="fail"))
    assert {each.standing for each in answer.conditions} == {"worse"}
    assert {each.remark for each in answer.conditions} == {
        "newly missed: locked-wheels; test: newly missed: grip"
    }
    assert answer.sentences[0].endswith("worse in all 9 conditions: requirements no longer met.")
    assert answer.sentences[1] == (
        "Verdicts that turned: requirements: locked-wheels newly missed in 9 cases; validity as a test: grip"
        " newly missed in 9 cases. Requirements are missed in 0 cases with 3.1 and 9 cases with 4.0."
    )
    # A test that is no longer valid says nothing of which is better.
    answer = _answer(_cases((0.0,) * 3), _cases((0.0,) * 3, validity="fail"))
    assert answer.standing == "no difference shown"


@pytest.mark.parametrize(
    ("column", "second", "standing", "said"),
    [
        pytest.param(
            "braking_distance_m", (400.5, 401.0), "worse", "distance 0.5 to 1 m longer", id="ends-in-1"
        ),
        pytest.param(
            "sliding_share", (1.5, 2.0), "different", "sliding share 1.5 to 2 larger", id="pure-number"
        ),
    ],
)
def test_a_number_of_one_is_kept_and_a_measure_without_a_better_side_differs(column, second, standing, said):
    def conditions(values):
        return tuple(
            Condition(
                f"c{k}",
                standing,
                PairedDifference(column, unit, 0.0, 0.0, mean_of([v], 0.95), None, 1, 0, 0),
                by_number=True,
            )
            for k, v in enumerate(values)
        )

    unit = column_unit(column)
    shifts = [value - 400.0 for value in second] if unit == "m" else second
    answer = Answer(("a", "b"), conditions(shifts))
    assert answer.conditions[0].lead.standing(Tolerances()) == standing
    assert answer.sentences[0].endswith(f"{said}.")
    assert answer.verdict.startswith(f"b is {standing}")


@pytest.mark.parametrize(
    ("changes", "standing", "remark"),
    [
        # A train that rolls on locks no wheels: no criterion turned, and nothing is better.
        ({"distance": math.nan}, "not comparable", "not every stop came to a standstill"),
        (
            {"criteria": (replace(LOCKED, status="inconclusive"),), "distance": math.nan},
            *("worse", "no longer shown to be met: locked-wheels; not every stop came to a standstill"),
        ),
        (
            {"criteria": (LOCKED, make_verdict(id="balance", layer="rig", status="fail"))},
            *("not comparable", "checks fail: balance"),
        ),
        (
            {"criteria": (replace(LOCKED, id="new", status="fail"),)},
            *("better", "on the first side alone: locked-wheels; on the second side alone: new"),
        ),
    ],
)
def test_a_stop_that_is_not_whole_is_not_better(changes, standing, remark):
    (first, *_), (second, *_) = _cases((0.0,) * 3), _cases((-20.0,) * 3)
    first = replace(first, criteria=(LOCKED,))
    stops = second.repeats.stops
    measures = {**stops[0].measures, "braking_distance_m": changes.get("distance", 480.0)}
    repeats = replace(second.repeats, stops=(replace(stops[0], measures=measures), *stops[1:]))
    second = replace(second, criteria=changes.get("criteria", (LOCKED,)), repeats=repeats)
    [condition] = _answer([first], [second]).conditions
    assert (condition.standing, condition.remark) == (standing, remark)


def test_what_is_not_compared_is_in_the_shortest_answer_and_in_the_notes():
    one, *others = _cases((0.0,) * 3)
    found = compare_runs(
        _run("one", [one, *others]), replace(_run("other", [one]), complete=False), Tolerances()
    )
    assert found.answer.verdict.endswith(" in 1 of 9 conditions")
    assert found.notes[0] == "other is incomplete: not all that was selected was run"


def test_a_changed_digest_gives_no_name_beside_a_changed_parameter():
    digest, slide = ParameterChange("c.sha256", "a", "b", ()), ParameterChange("c.upper_slide", "1", "2", ())
    assert subject_names(RunContent("", []), RunContent("", []), [digest, slide]) == (
        "upper_slide 1",
        "upper_slide 2",
    )


def test_verdicts_of_series_are_counted_as_such():
    change = StatusChange("pass", "fail", "k-wet")
    turned = (
        TurnedVerdict("a", "requirement", change),
        TurnedVerdict("s", "requirement", change, of_series=True),
    )
    sentence = Answer(("a", "b"), (), turned).turned_sentence
    assert sentence == "Verdicts that turned: requirements: k-wet newly missed in 1 case, 1 series."


def test_tables_name_both_sides_and_a_title_every_variant():
    run = make_run()
    runs = [replace(run, name=name) for name in ("b", "c", "a long name")]
    found = [compare_runs(replace(run, name="a"), other, Tolerances()) for other in runs]
    document = comparison_document(*found, every=True)
    assert document.title == "a and b and c and a long name"
    lines = list(document_lines(comparison_document(found[2]), 100))
    assert "In tables, first is a and second is a long name." in lines
    assert found[0].headings == []
    table = differing_table([Difference("x", "outcome", "pass", "fail", within=False)], ("a", "b"))
    assert {"a", "b"} <= {column.heading for column, _ in table.for_people}


@pytest.mark.parametrize(
    ("changes", "names"),
    [({}, ("run", "again")), ({"versions": {"uictest": "9.1"}}, ("uictest 9.0", "uictest 9.1"))],
)
def test_runs_of_one_controller_are_called_by_what_else_differs(changes, names):
    first = replace(make_run(), manifest=RunManifest(versions={"uictest": "9.0"}))
    second = replace(make_run("again"), manifest=replace(first.manifest, **changes))
    assert compare_runs(first, second, Tolerances()).answer.subjects == names


@pytest.mark.parametrize(("tolerances", "deciding"), [((), []), (("braking_*=1",), ["braking_distance_m"])])
def test_a_measure_that_no_criterion_judges_informs_unless_a_tolerance_names_it(tolerances, deciding):
    accepted, run = make_run(), make_run(braking_distance_m=470.0, sliding_share=0.5)
    results = {each.id: each for each in accepted.results}
    read = Tolerances.read(tolerances)
    found = Baseline("kept", "00", accepted, results, {}, Scope(frozenset()), read).compare(run)
    assert [each.quantity for each in found.all_differences] == deciding
    assert found.agrees == (not deciding)
    quantities = {each.quantity for each in (*found.all_differences, *found.informing)}
    assert quantities == {"braking_distance_m", "sliding_share"}
    judged = [replace(each, criteria=(make_verdict(measure="sliding_share"),)) for each in run.results]
    found = Baseline("kept", "00", accepted, results, {}, Scope(frozenset()), read).compare(
        replace(run, results=judged)
    )
    assert "sliding_share" in [each.quantity for each in found.all_differences]
