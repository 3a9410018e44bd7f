"""`uictest selftest`: exit codes, and the findings as text, JSON and JUnit."""

import json
import math
from pathlib import Path

import junitparser
import pytest

from uictest import report, selftest
from uictest.selftest import examination


def no_answer(stops):
    raise ZeroDivisionError("no wheel load")


def not_here(stops):
    raise selftest.NotCheckedError("no C compiler (cc)")


CHECKS = {
    "met": selftest.Check("tank", "physics", "a tank", lambda stops: selftest.Answer(1.0, 1.001), 0.01, "K"),
    "missed": selftest.Check(
        "stop", "numerics", "a stop", lambda stops: selftest.Answer("a1", "b2", "1 differs")
    ),
    "error": selftest.Check("creep", "physics", "the creep", no_answer),
    "nothing": selftest.Check("air", "physics", "air", lambda stops: selftest.Answer(300.0, math.nan), 0.01),
    "close": selftest.Check("play", "physics", "a play", lambda stops: selftest.Answer(1.0, 1.000000001)),
    "skipped": selftest.Check("c", "controllers", "a controller in C", not_here),
}
FOUR = ("met", "missed", "error", "skipped")
"""With each verdict once."""


@pytest.fixture
def asks(monkeypatch):
    """Let the installation be asked only some made-up questions."""

    def ask(*names):
        monkeypatch.setattr(examination, "all_checks", lambda stops: [CHECKS[name] for name in names])

    return ask


@pytest.mark.parametrize(
    ("names", "code"),
    [(("met",), 0), (("met", "skipped"), 0), (("met", "missed"), 1), (("missed", "error"), 3)],
)
def test_exit_code_is_that_of_the_worst_finding(call, asks, names, code):
    asks(*names)
    assert call("selftest").code == code


def test_the_table_names_what_was_expected_and_found_to_the_tenth_digit_and_hides_nothing(call, asks):
    asks(*FOUR)
    lines = call("selftest").out.splitlines()
    words = [" ".join(line.split()) for line in lines]
    assert {"tank pass 1 1.001 1 % K a tank", "stop fail a1 b2 exact a stop"} <= set(words)
    assert lines[-4:] == [
        "fail stop: 1 differs",
        "error creep: ZeroDivisionError: no wheel load",
        "skipped c: no C compiler (cc)",
        "4 checks: 1 skipped, 1 pass, 1 fail, 1 error",
    ]
    asks("close")
    assert "1.000000001" in call("selftest").out


@pytest.mark.parametrize(
    ("width", "hidden"),
    [(None, []), (100, []), (45, ["within", "requirement"]), (36, ["within", "unit", "requirement"])],
)
def test_a_narrow_table_keeps_the_verdict_and_says_what_it_leaves_out(width, hidden):
    """What was expected and found goes last, and is in JSON all the same."""
    stops = selftest.KnownStops()
    examined = selftest.examine(stops, [CHECKS["met"]])
    lines = list(report.document_lines(selftest.finding_document(examined), width))
    [titles] = [line for line in lines if line.startswith("check ")]
    shown = {"verdict", "expected", "found", "within", "unit", "requirement"} - set(hidden)
    assert {title for title in shown | set(hidden) if title in titles} == shown
    _, *said = " ".join(" ".join(lines).split()).split("not shown for lack of room: ")
    assert [text.partition(" has all")[0] for text in said] == [f"{', '.join(hidden)}; --format json"] * bool(
        hidden
    )


def test_json_has_the_installation_and_every_finding_with_numbers_as_numbers(call, asks):
    asks(*FOUR, "nothing")
    document = json.loads(call("selftest", "--format", "json").out)
    assert (document["schema"], document["status"]) == ("uictest/selftest/2", "error")
    assert {"uictest", "python", "processor", "numpy"} <= set(document["about"])
    met, missed, *_, nothing = document["checks"]
    assert [each["status"] for each in document["checks"]] == ["pass", "fail", "error", "skipped", "fail"]
    assert (met["expected"], met["found"], met["tolerance"]) == (1.0, 1.001, 0.01)
    assert (nothing["expected"], nothing["found"]) == (300.0, None)
    about = {"id": "stop", "group": "numerics", "requirement": "a stop", "origin": "own stored output"}
    judged = {"status": "fail", "reason": "1 differs", "tolerance": 0.0, "unit": ""}
    assert missed == {**about, **judged, "expected": "a1", "found": "b2"}


def test_junit_has_a_testcase_for_every_question_that_says_why_it_failed(call, asks):
    asks(*FOUR, "nothing")
    call("selftest", "--junitxml", "selftest.xml")
    [suite] = junitparser.JUnitXml.fromfile(str(Path("selftest.xml")))
    assert (suite.tests, suite.failures, suite.errors, suite.skipped) == (5, 2, 1, 1)
    kinds = [type(case.result[0]).__name__ if case.result else "" for case in suite]
    assert kinds == ["", "Failure", "Error", "Skipped", "Failure"]
    messages = [case.result[0].message for case in suite if case.result]
    assert (messages[0], messages[-1]) == ("1 differs", "air: expected 300, found nan")
    assert {"uictest", "processor", "stored stops"} <= {each.name for each in suite.properties()}
