from __future__ import annotations

import pytest

from uictest.campaign import BatchResult
from uictest.cli.exit_codes import ExitCode, of_batch
from uictest.evaluation import CaseResult


def _campaign(*outcomes: str, interrupted: bool = False) -> BatchResult:
    results = [CaseResult(outcome, "a.yaml", {}, "pass", outcome) for outcome in outcomes]  # type: ignore[arg-type]
    return BatchResult(results, interrupted)


@pytest.mark.parametrize(
    ("campaign", "code"),
    [
        (_campaign("pass", "skipped"), ExitCode.MET),
        (_campaign("pass", "fail"), ExitCode.MISSED),
        (_campaign("invalid"), ExitCode.MISSED),
        (_campaign("fail", "error"), ExitCode.ERROR),
        (_campaign("fail", "error", interrupted=True), ExitCode.INTERRUPTED),
        (_campaign(interrupted=True), ExitCode.INTERRUPTED),
    ],
)
def test_what_outweighs_what(campaign: BatchResult, code: ExitCode) -> None:
    assert of_batch(campaign) is code


def test_the_codes_are_those_that_the_documentation_promises() -> None:
    assert [(code.name, int(code)) for code in ExitCode] == [
        ("MET", 0),
        ("MISSED", 1),
        ("INTERRUPTED", 2),
        ("ERROR", 3),
        ("USAGE", 4),
        ("NOTHING_SELECTED", 5),
    ]
