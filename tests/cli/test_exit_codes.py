from pathlib import Path

import pytest

from uictest.cli.output import ExitCode, of_run
from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import PASS
from uictest.report import RunContent
from uictest.runs import Published


def _run(*outcomes, interrupted=False):
    results = [CaseResult(outcome, "a.yaml", {}, PASS, outcome) for outcome in outcomes]
    return Published(Path("run"), RunContent("run", results), "{}", interrupted)


@pytest.mark.parametrize(
    ("run", "code"),
    [
        (_run("pass", "pass"), ExitCode.MET),
        (_run("pass", "skipped"), ExitCode.MISSED),
        (_run("pass", "fail"), ExitCode.MISSED),
        (_run("invalid"), ExitCode.MISSED),
        (_run("fail", "error"), ExitCode.ERROR),
        (_run("fail", "error", interrupted=True), ExitCode.INTERRUPTED),
        (_run(interrupted=True), ExitCode.INTERRUPTED),
    ],
)
def test_what_outweighs_what(run, code):
    assert of_run(run) is code


def test_the_codes_are_those_that_the_documentation_promises():
    assert [(code.name, int(code)) for code in ExitCode] == [
        ("MET", 0),
        ("MISSED", 1),
        ("INTERRUPTED", 2),
        ("ERROR", 3),
        ("USAGE", 4),
        ("NOTHING_SELECTED", 5),
    ]
