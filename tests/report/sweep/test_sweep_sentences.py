"""A sweep in words: its values, counts, shares, flips, notable cases, and what a CI server is told."""

import shlex

import numpy as np
import pytest
from pydantic import TypeAdapter

from uictest.judging.evaluation import Deviation, Sensitivity, VerdictInterval
from uictest.plans.scenario import expectation_of
from uictest.report import DrawnInterval, Flip, OutcomeCount, SweptValue, WrittenValue
from uictest.report.sweep.result import OutsideCount, SurveyBias, SurveyStep, SweepDomain
from uictest.report.sweep.sweep_sentences import (
    bar,
    circumstances_words,
    command_alone,
    domain_notes,
    flip_words,
    missed_blocks,
    share_words,
    survey_notes,
    sweep_annotations,
    sweep_suite,
    sweep_tally,
    swept_words,
    where_met,
)
from uictest.report.sweep.values import interval_indices, range_label

from ..builders import HOSTILE, make_result, make_verdict
from ..sweep_rows import sweep_result

ADAPTER = TypeAdapter(SweptValue)


@pytest.mark.parametrize(
    ("value", "text", "number", "unit"),
    [
        (WrittenValue("80 km/h"), "80 km/h", 80.0, "km/h"),
        (WrittenValue("0.12"), "0.12", 0.12, ""),
        (WrittenValue("one-caliper"), "one-caliper", None, ""),
        (WrittenValue(""), "", None, ""),
        (WrittenValue("0.1 .. 0.2"), "0.1 .. 0.2", 0.1, ".. 0.2"),
    ],
)
def test_a_written_value_keeps_its_number_and_is_its_text_in_json(value, text, number, unit):
    assert ADAPTER.dump_python(value, mode="json") == text
    assert ADAPTER.validate_python(text) == value
    assert (value.label, value.number, value.unit) == (text, pytest.approx(number), unit)


@pytest.mark.parametrize(
    ("interval", "label", "middle"),
    [
        (DrawnInterval(60.0, 70.0, "%"), "60 .. 70 %", 65.0),
        (DrawnInterval(2.19e-8, 2.38e-8, "m3/s"), "2.19e-08 .. 2.38e-08 m3/s", 2.285e-8),
        (DrawnInterval(-0.5, 0.0, ""), "-0.5 .. 0", -0.25),
    ],
)
def test_an_interval_is_its_ends_in_json(interval, label, middle):
    form = {"low": interval.low, "high": interval.high, "unit": interval.unit}
    assert ADAPTER.dump_python(interval, mode="json") == form
    assert ADAPTER.validate_python(form) == interval
    assert (interval.label, interval.number) == (label, pytest.approx(middle))


@pytest.mark.parametrize(
    "other", [None, 3, ["a"], {"low": 1.0, "unit": "m"}, {"low": "a", "high": 2, "unit": ""}]
)
def test_what_is_neither_text_nor_interval_is_no_value(other):
    with pytest.raises(ValueError, match="validation error"):
        ADAPTER.validate_python(other)


@pytest.mark.parametrize(
    ("unit", "numbers", "expected"),
    [
        ("km/h", [0.0, 19.99, 20.0, 50.0], [0, 0, 1, 1]),  # 72 km/h
        ("", [71.9, 72.0], [0, 1]),
        ("degC", [345.14, 345.15], [0, 1]),
    ],
)
def test_a_number_at_a_boundary_lies_in_the_upper_interval(unit, numbers, expected):
    intervals = [DrawnInterval(36.0, 72.0, unit), DrawnInterval(72.0, 108.0, unit)]
    assert interval_indices(intervals, np.array(numbers)).tolist() == expected


def test_neighbouring_values_are_labelled_by_their_ends():
    intervals = [DrawnInterval(0.06, 0.07, "m"), DrawnInterval(0.07, 0.08, "m")]
    assert range_label(intervals) == "0.06 .. 0.08 m"
    assert range_label(intervals[:1]) == "0.06 .. 0.07 m"
    assert range_label([WrittenValue("dry"), WrittenValue("wet")]) == "dry .. wet (2 values)"
    assert range_label([WrittenValue("dry")]) == "dry"


OUTCOMES = {"pass": 70, "fail": 1, "invalid": 0, "error": 1, "skipped": 0, "inconclusive": 3}


@pytest.mark.parametrize(
    ("met", "outcomes", "text"),
    [
        (70, OUTCOMES, "75 cases: 70 pass, 1 fail, 1 error, 3 inconclusive; 5 not as expected"),
        (75, {"pass": 3, "error": 0, "skipped": 72}, "75 cases: 3 pass, 72 skipped"),
    ],
)
def test_a_sweep_is_counted_by_outcome(met, outcomes, text):
    assert sweep_tally(sweep_result({"a": ["1"]}, 75, met=met, outcomes=outcomes)) == text


@pytest.mark.parametrize(
    ("values", "shown"),
    [
        ([WrittenValue("80 %"), WrittenValue("90 %")], "80 %, 90 %"),
        ([WrittenValue(f"0.{k}") for k in (1, 2, 3, 4)], "0.1 .. 0.4 (4 values)"),
        ([WrittenValue(f"{k} %") for k in (50, 100, 200, 80)], "50 % .. 200 % (4 values)"),
        ([WrittenValue(text) for text in "badc"], "b, a, d, … (4 values)"),
        ([DrawnInterval(0.08, 0.12, "m/s"), DrawnInterval(0.12, 0.16, "m/s")], "0.08 .. 0.16 m/s, drawn"),
        ([], ""),
    ],
)
def test_what_is_swept_is_described_by_its_ends(values, shown):
    assert swept_words(values) == shown


@pytest.mark.parametrize(
    ("met", "cases", "share", "blocks"),
    [(1000, 1000, "100", 10), (999, 1000, "99", 9), (1, 1000, "1", 1), (0, 9, "0", 0), (1, 4, "25", 2)],
)
def test_only_what_is_whole_is_shown_as_whole_and_no_case_has_no_share(met, cases, share, blocks):
    assert share_words(met, cases) == share
    assert bar(met, cases) == "█" * blocks + "░" * (10 - blocks)
    assert (share_words(0, 0), bar(0, 0)) == ("-", "")
    assert OutcomeCount(WrittenValue("1"), 0, 0, {}).share_met is None


LOW, HIGH = WrittenValue("0.10"), WrittenValue("0.11")


@pytest.mark.parametrize(
    ("said", "text"),
    [
        (flip_words(Flip(LOW, HIGH, met_at_low=True)), "met up to 0.10, not met from 0.11"),
        (flip_words(Flip(LOW, HIGH, met_at_low=False)), "not met up to 0.10, met from 0.11"),
        (circumstances_words({"a": WrittenValue("1"), "b": WrittenValue("2 m")}), "a = 1, b = 2 m"),
        (circumstances_words({}), "all cases"),
        (command_alone({"file": "-x y.sweep.yaml"}),
         "uictest sweep './-x y.sweep.yaml' -k 'CASE' -o 'alone/CASE'",),
        (command_alone({}), "uictest sweep FILE -k 'CASE' -o 'alone/CASE'"),
    ],
)  # fmt: skip
def test_flips_circumstances_and_commands_are_told(said, text):
    assert said == text


def test_one_case_alone_runs_as_in_the_sweep_in_a_folder_of_its_own():
    words = shlex.split(command_alone({"file": "a b.sweep.yaml", "set": ["brake.command=80 %"], "seed": 3}))
    assert words[:3] == ["uictest", "sweep", "a b.sweep.yaml"]
    given = dict(zip(words[3::2], words[4::2], strict=True))
    assert given == {"--set": "brake.command=80 %", "--seed": "3", "-k": "CASE", "-o": "alone/CASE"}


NONE = dict.fromkeys(("pass", "fail", "invalid", "inconclusive", "error", "skipped"), 0)


@pytest.mark.parametrize(
    ("count", "status", "lines"),
    [
        ({"cases": 2, "met": 2, "outcomes": NONE | {"pass": 2}}, "passed", []),
        ({"cases": 2, "met": 1, "outcomes": NONE | {"pass": 1, "fail": 1}}, "failure",
         ["1 of 2 cases did not meet their expectation", "pass: 1, fail: 1", "the first of the whole sweep:",
         "lost[pads]: invalid, pads",]),
        ({"cases": 2, "met": 1, "outcomes": NONE | {"pass": 1, "error": 1}}, "error", None),
        ({"cases": 0, "met": 0, "outcomes": NONE}, "skipped", None),
        ({"cases": 2, "met": 2, "outcomes": NONE | {"skipped": 2}}, "skipped", None),
        ({"cases": 2, "met": 0, "outcomes": NONE | {"skipped": 2}}, "failure", None),
    ],
)  # fmt: skip
def test_a_value_of_the_first_parameter_is_a_testcase(make_sweep, count, status, lines):
    content = make_sweep(text="pads", rates={"rail.friction": [{"value": "0.1"} | count], "x": []})
    (testcase,) = sweep_suite(content.result, content.manifest["file"]).testcases
    assert (testcase.class_name, testcase.name) == ("scenarios.pads.sweep", "pads[rail.friction=0.1]")
    assert testcase.status == status
    assert lines is None or testcase.lines == lines


def test_testcases_have_the_ids_of_test_management_where_asked(make_sweep):
    content = make_sweep(requirements=["BR-1", "BR-2"], test_case="TC-7")
    plain, named = (sweep_suite(content.result, "a.yaml", with_properties=asked) for asked in (False, True))
    assert plain.properties == named.properties == {"requirements": "BR-1,BR-2"}
    assert not any(testcase.properties for testcase in plain.testcases)
    ids = {"polarion-testcase-id": "TC-7", "test_key": "TC-7", "requirements": "BR-1,BR-2"}
    assert [testcase.properties for testcase in named.testcases] == [ids, ids]


def annotations(content):
    return list(sweep_annotations(content.result, content.manifest))


def test_what_is_missed_is_annotated_once_for_each_outcome_and_the_sweep_is_counted(make_sweep):
    missed = make_result(id="b[x]", outcome="fail", criteria=(), reason="locked")
    outcomes = NONE | {"pass": 1, "fail": 2, "invalid": 1}
    content = make_sweep((missed, make_result()), "pads", outcomes=outcomes, met=1)
    command = "uictest sweep scenarios/pads.sweep.yaml --set pads -k '{0}' -o 'alone/{0}'"
    first, second, tally = annotations(content)
    assert first.startswith("::error file=scenarios/pads.sweep.yaml,title=2 cases miss requirements")
    assert first.endswith(f"::worst b[x]: locked; {command.format('b[x]')}")
    assert second.startswith("::error file=scenarios/pads.sweep.yaml,title=1 case is not a valid test")
    assert second.endswith(f"::first lost[pads]: pads; {command.format('lost[pads]')}")
    counts = "4 cases: 1 pass, 2 fail, 1 invalid; 3 not as expected"
    assert tally == f"::notice file=scenarios/pads.sweep.yaml,title=uictest sweep pads::{counts}"
    # A hostile name cannot start a command of its own.
    bad = make_result(id=HOSTILE, parameters={HOSTILE: HOSTILE}, outcome="error", reason=HOSTILE)
    for line in annotations(make_sweep((bad,), HOSTILE, outcomes=NONE | {"error": 4}, met=0)):
        assert line.startswith(("::error file=", "::notice file="))
        assert not set("\n\r\x00\x1b\u202e") & set(line)
        assert line.split("::")[1].count(",") == 1


@pytest.mark.parametrize(
    ("expect", "outcomes", "met", "headings"),
    [
        ("pass", {"pass": 4}, 4, []),
        (
            "pass",
            {"pass": 1, "fail": 2, "error": 1},
            1,
            ["1 case could not be run", "2 cases miss requirements"],
        ),
        ("fail", {"fail": 3, "pass": 1}, 3, ["1 case should not have passed"]),
        ("pass", {"pass": 4}, 2, ["2 cases have verdicts that are not settled"]),
        ("fail", {"fail": 4}, 3, ["1 case meets an expectation that --strict refuses"]),
        ("fail", {"fail": 3, "inconclusive": 1}, 2, ["1 case misses requirements", "1 case lacks data"]),
    ],
)
def test_what_is_expected_is_not_missed(make_sweep, expect, outcomes, met, headings):
    turns = Sensitivity("a", "m", 0.0, 1.0, (VerdictInterval(0, 0, "pass"), VerdictInterval(1, 1, "fail")))
    unsettled = make_verdict(sensitivity=(turns,))
    open_cases = {"pass": unsettled, "fail": make_verdict(status="fail", layer="requirement")}
    common = {"id": "a", "expect": expectation_of(expect), "strict": len(outcomes) == 1}
    worst = tuple(make_result(**common, outcome=name, criteria=(each,)) for name, each in open_cases.items())
    content = make_sweep(worst, outcomes=NONE | outcomes, met=met, missed=[], rates={"x": []})
    blocks = [block for block, _ in missed_blocks(content.result, {})]
    assert len(blocks) == len(headings)
    assert all(block.heading.startswith(heading) for block, heading in zip(blocks, headings, strict=True))


@pytest.mark.parametrize(
    ("met", "said"),
    [
        ((2, 2, 2), "6 of 6 cases as expected"),
        ((0, 0, 0), "0 of 6 cases as expected"),
        ((2, 1, 0), "3 of 6 cases as expected, by x: all at 0; in part at 1; none at 2"),
        ((1, 1, 1), "3 of 6 cases as expected; no value of x decides alone"),
        ((2, 0, 2), "4 of 6 cases as expected, by x: all at 0, 2; none at 1"),
        ((2, 0, None), "2 of 4 cases as expected, by x: all at 0; none at 1"),
    ],
)
def test_where_a_sweep_holds_is_said_by_the_parameter_that_decides(make_sweep, met, said):
    cases = [0 if each is None else 2 for each in met]
    counts = [
        {"value": str(k), "cases": cases[k], "met": each or 0, "outcomes": {}} for k, each in enumerate(met)
    ]
    content = make_sweep(cases=sum(cases), met=sum(filter(None, met)), rates={"x": counts})
    assert where_met(content.result) == said


SPEED = OutsideCount(3, Deviation("initial_speed", (30.0, 40.0), (10.0, 20.0), "m/s"))
BIASES = (SurveyBias("braking distance", 0.0012, "slip-120", 0.05), SurveyBias("time", 1e-5, "dry", 0.0))


BIASED = "bias of the survey step"
OUTSIDE = "3 of 5 cases outside of what my-train validated"


@pytest.mark.parametrize(
    ("notes", "said"),
    [
        (domain_notes(None, 5), []),
        (domain_notes(SweepDomain("a", "00", 0), 1), ["0 of 1 case outside of what a validated"]),
        (domain_notes(SweepDomain("my-train", "00", 3, (SPEED,) * 7), 5),
         [f"{OUTSIDE}: {'initial_speed 144 km/h > 72 km/h in 3; ' * 6}1 more condition in results.json"]),
        (survey_notes(None, 5), []),
        (survey_notes(SurveyStep("1 ms", "0.5 ms", 0, BIASES, ("energy",)), 5),
         ["survey in steps of 1 ms, which settled all of 5 cases",
          f"{BIASED}: not known of energy",
          f"{BIASED}: braking distance at most 0.12 % on average (slip-120), 5 % in 95 % of single stops",
          f"{BIASED}: below 0.01 % in 1 other measure judged or mapped"]),
        (survey_notes(SurveyStep("1 ms", "0.5 ms", 2, ()), 5),
         [("survey in steps of 1 ms, which could not settle 2 of 5 cases:"
           " these were repeated in steps of 0.5 ms")]),
    ],
)  # fmt: skip
def test_what_bounds_a_sweep_is_noted(notes, said):
    assert list(notes) == said
