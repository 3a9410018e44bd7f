"""Two runs side by side: figures, tolerances, parameters, and what is shown of them."""

from dataclasses import replace

import numpy as np
import pytest

from uictest.analysis.comparison import (
    Baseline,
    Scope,
    Tolerance,
    Tolerances,
    compare_recordings,
    comparison_document,
    comparison_html,
    verdict_line,
)
from uictest.analysis.comparison.comparison_document import differing_table
from uictest.analysis.comparison.parameters import ParameterChange, change_text
from uictest.analysis.comparison.runs import compare_runs
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.judging.evaluation import EffectivePart, Parameter
from uictest.report import RunContent, document_lines, table_lines
from uictest.report.difference import worst_of_wheelsets
from uictest.report.page import page_html
from uictest.report.run_folder import baseline_form, read_baseline_comparison
from uictest.report.traces.trace import trace_of

from ..report.builders import make_content, make_result, make_verdict
from .conftest import make_recording, make_run

DEFAULT = Tolerances()


def test_a_figure_that_moved_is_named_with_both_values_and_agrees_within_its_tolerance():
    found = compare_runs(make_run(), make_run(braking_distance_m=470.0), DEFAULT)
    (difference,) = found.beyond
    assert (difference.case, difference.quantity) == ("dry-120", "braking_distance_m")
    assert (difference.first, difference.second, difference.unit) == (465.0, 470.0, "m")
    assert (difference.deviation, difference.allowed) == (5.0, pytest.approx(0.47))
    within = compare_runs(make_run(), make_run(braking_distance_m=470.0), Tolerances.read(["braking_*=5"]))
    assert (within.agrees, [each.within for each in within.differences]) == (True, [True])


@pytest.mark.parametrize(
    ("changes", "quantity"),
    [
        ({"outcome": "invalid"}, "outcome"),
        ({"verdict": "fail"}, "criterion braking-distance"),
        ({"initial_adhesion_g": 0.1}, "initial_adhesion_g"),
        ({"braking_time_s": float("nan")}, "braking_time_s"),
    ],
)
def test_no_tolerance_lets_a_verdict_or_a_missing_figure_pass(changes, quantity):
    found = compare_runs(make_run(), make_run(**changes), Tolerances.read(["100000"]))
    assert [difference.quantity for difference in found.beyond] == [quantity]


def test_a_case_on_one_side_only_is_a_difference_on_either_side():
    found = compare_runs(make_run(), make_run(case_id="other"), DEFAULT)
    shown = [(each.case, each.quantity, each.first, each.second) for each in found.beyond]
    assert shown == [("dry-120", "case", "pass", "missing"), ("other", "case", "missing", "pass")]


def test_what_went_in_differently_is_noted_and_no_difference():
    other = make_run()
    manifest = replace(other.manifest, seed=1, inputs={"dry.yaml": "b" * 64})
    found = compare_runs(make_run(), RunContent("run", other.results, manifest), DEFAULT)
    assert found.agrees
    assert found.notes == ["seed: 0 -> 1", "inputs: dry.yaml: aaaaaaaaaaaa... -> bbbbbbbbbbbb..."]


NOW = make_result(id="dry", criteria=(make_verdict(value=465.25), make_verdict(id="slide", unit="%")))


def _compared(*accepted):
    """A drawn case, compared with what was accepted of it."""
    kept = {"dry": replace(NOW, criteria=accepted)}
    content = RunContent("kept", list(kept.values()))
    baseline = Baseline("kept", "00", content, kept, {}, Scope(frozenset()), DEFAULT)
    run = make_content(NOW, make_result(id="added"), traces={"dry": trace_of(make_recording())})
    return replace(run, baseline=baseline.compare(run))


def test_the_table_of_criteria_of_a_stop_has_the_accepted_values():
    content = _compared(make_verdict(value=460.5), make_verdict(id="slide", unit="%", value=None))
    assert content.baseline.values == {"dry": {"braking-distance": 460.5}}
    page = page_html(content)
    assert page.count("<small>baseline 460.5 m</small>") == page.count("<small>baseline ") == 1
    assert read_baseline_comparison({"baseline": baseline_form(content.baseline)}) == content.baseline
    assert "<small>baseline " not in page_html(replace(content, baseline=None))
    # A value in another unit is not set beside.
    content = _compared(make_verdict(value=0.4605, unit="km"), make_verdict(id="slide", unit="%", value=7.0))
    assert content.baseline.values == {"dry": {"slide": 7.0}}


@pytest.mark.parametrize(
    ("texts", "quantity", "expected"),
    [
        ([], "anything", Tolerance(1e-6, 1e-3)),
        (["1 %"], "anything", Tolerance(1e-6, 0.01)),
        (["1e-3"], "anything", Tolerance(1e-3, 0.0)),
        (["0.5", "1%", "0.2"], "anything", Tolerance(0.2, 0.01)),
        (["slide_*=0.02", "1%"], "slide_3", Tolerance(0.02, 0.0)),
        (["slide_*=0.02", "slide_3=5%"], "slide_3", Tolerance(1e-6, 0.05)),
        (["slide_*=0.02", "slide_3=5%", "slide_*=1%"], "slide_3", Tolerance(0.02, 0.01)),
        (["slide_*=0.02", "slide_3=5%"], "slide_4", Tolerance(0.02, 0.0)),
    ],
)
def test_the_last_pattern_that_fits_counts(texts, quantity, expected):
    assert Tolerances.read(texts).of(quantity) == expected


@pytest.mark.parametrize("text", ["", "x", "-1", "1 m", "a=", "a=b", "nan", "inf", "1..2", "=1", "1e999"])
def test_what_is_no_tolerance_is_named(text):
    with pytest.raises(ValueError, match="is not a tolerance"):
        Tolerances.read([text])


def test_the_larger_allowance_counts():
    assert Tolerance(0.5, 0.01).allowed(10.0) == 0.5
    assert Tolerance(0.5, 0.01).allowed(100.0) == 1.0
    assert Tolerance(0.5, 0.01).allowed(float("nan")) == 0.5


def controller(slip, name="threshold"):
    parameter = Parameter("controller.slip_threshold", slip / 3.6, "m/s", f"{slip:g} km/h", "user")
    return EffectivePart("controller", "controller", name, "threshold", (parameter,))


def run_with(run, part):
    (result,) = run.results
    return replace(run, results=[replace(result, parts={"controller": part})])


def compared(first, second, **changes):
    return compare_runs(run_with(make_run(), first), run_with(make_run(**changes), second), Tolerances())


def test_the_parameter_that_changed_is_named_and_is_no_difference():
    assert compared(controller(4), controller(4)).parameters == []
    found = compared(controller(4), controller(3))
    assert (found.agrees, list(found.notes)) == (True, [])
    found = compared(controller(4), controller(3), braking_distance_m=470.0)
    change = ParameterChange("controller.slip_threshold", "4 km/h", "3 km/h", ("dry-120",))
    assert found.parameters == [change]
    lines = document_lines(comparison_document(found), None)
    assert "parameter controller.slip_threshold: 4 km/h -> 3 km/h (in dry-120)" in lines
    assert found.to_dict()["parameters"][0]["second"] == "3 km/h"
    html = comparison_html(found)
    assert '<td data-label="first">4 km/h</td><td data-label="second">3 km/h</td>' in html
    assert "var uPlot=" not in html  # nothing is drawn
    # Another part is named as well as its parameters.
    assert [change_text(change) for change in compared(controller(4), controller(3, "mine")).parameters] == [
        "controller: threshold -> mine",
        "controller.slip_threshold: 4 km/h -> 3 km/h",
    ]


@pytest.mark.parametrize(
    ("first", "second", "changes"),
    [
        (("1.2",), ("1.3",), ["controller.version: 1.2 -> 1.3"]),
        (("1.2",), ("1.2",), []),
        (("1.2",), ("",), []),  # the second stop ended in an error
        (("1.2",), ("1.3", "1.3"), ["controller.version: 1.2 -> 1.3"]),
        (("1.2", "1.2"), ("1.3", "1.2"), ["controller.told_version: none -> 1.3"]),
    ],
)
def test_another_version_that_a_controller_tells_is_named(first, second, changes):
    def run_of(version, stated=""):
        facts = {"library": "wsp.so"} | ({"version": stated} if stated else {})
        rows = tuple(Parameter(f"controller.{key}", text, "", text, "user") for key, text in facts.items())
        run = run_with(make_run(), EffectivePart("controller", "controller", "wsp", None, rows))
        return replace(run, results=[replace(result, controller_version=version) for result in run.results])

    found = compare_runs(run_of(*first), run_of(*second), DEFAULT)
    assert found.agrees
    assert [change_text(change) for change in found.parameters] == changes


COMPARED = 1 + 1 + len(STOP_COLUMNS) + 2 * len(WHEELSET_COLUMNS)
"""Figures of a stop with two wheelsets, its outcome and the verdict of a criterion."""
HOSTILE = "\x1b[31m=cmd() <b>x</b></script>\u202e"


def test_what_is_out_of_tolerance_stands_first_and_what_is_the_same_nowhere():
    found = compare_runs(make_run(), make_run(braking_distance_m=470.0, braking_time_s=27.51), DEFAULT)
    *heading, _, _ = rows = list(table_lines(differing_table(found.differences, found.subjects), None))
    expected = "verdict case quantity first second change % of allowed unit first"
    assert " ".join(" ".join(heading).split()) == expected
    rows = rows[len(heading) :]
    assert [row.split()[0] for row in rows] == ["differs", "within"]
    assert "(braking_distance_m)" in rows[0]
    assert rows[0].split()[-6:] == ["465", "470", "+5", "+1.08", "0.47", "m"]
    # The terminal has them where they are asked for.
    for every in (False, True):
        lines = document_lines(comparison_document(found, every=every), None)
        assert any(line in rows for line in lines) == every
    said = f"{COMPARED} quantities compared: 1 out of tolerance, 1 different within tolerance"
    assert verdict_line(found) == said
    found = compare_runs(make_run(), make_run(), DEFAULT)
    assert verdict_line(found) == f"{COMPARED} quantities compared, no difference"
    assert (found.agrees, list(found.differences), list(found.notes)) == (True, [], [])
    assert found.answer.verdict == "No difference shown between run and run"


@pytest.mark.parametrize("width", [60, 80, 100, 120, 200])
def test_on_a_narrow_terminal_the_case_stands_above_its_figures(width):
    case_id = "wet-80-friction[friction=0.10,command=80]"
    changes = {"braking_distance_m": 470.0, "verdict": "fail"}
    found = compare_runs(make_run(case_id=case_id), make_run(case_id=case_id, **changes), DEFAULT)
    lines = list(table_lines(differing_table(found.beyond, ("A", "B")), width))
    assert max(len(line) for line in lines if not line.startswith("not shown")) <= width
    assert any({"465", "470"} <= set(line.split()) for line in lines)
    hidden = [name for name in ("% of A", "allowed") if name not in "".join(lines[:3])]
    assert [name for name in hidden if name not in " ".join(lines[-3:])] == []


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


def test_the_worst_wheelset_stands_for_all():
    before, after = make_run(), make_run()
    slid = [{**after.results[0].wheelsets[0], "maximum_slide": slide} for slide in (0.3, 0.4)]
    after = RunContent("after", [replace(after.results[0], wheelsets=tuple(slid))])
    found = compare_runs(before, after, DEFAULT)
    assert [each.quantity for each in found.beyond] == ["maximum_slide_1", "maximum_slide_2"]
    (worst,) = worst_of_wheelsets(found.beyond)
    assert (worst.quantity, worst.remark) == ("maximum_slide_2", "worst of 2 wheelsets")
