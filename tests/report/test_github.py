from __future__ import annotations

from collections.abc import Callable

import pytest

from uictest.evaluation import CaseResult
from uictest.report.github import annotation, case_annotations, no_command

MakeResult = Callable[..., CaseResult]


def test_only_cases_that_are_not_met_are_annotated(make_result: MakeResult) -> None:
    assert list(case_annotations(make_result())) == []
    (line,) = case_annotations(make_result(outcome="fail", criteria=(), reason="locked"))
    properties, message = line.removeprefix("::error ").split("::")
    assert properties == "file=scenarios/dry/120.yaml,title=MISSED dry-120[command=90]"
    assert message == "expected pass, came out fail%0Alocked"


def test_an_annotation_carries_the_place_in_the_file() -> None:
    assert annotation("a.yaml", "key", "100 %", line=3, column=7) == (
        "::error file=a.yaml,line=3,col=7,title=key::100 %25"
    )


def test_a_hostile_name_cannot_start_a_command_of_its_own(make_result: MakeResult, hostile: str) -> None:
    (line,) = case_annotations(make_result(id=hostile, scenario=hostile, outcome="error"))
    assert line.startswith("::error file=")
    assert "\n" not in line


@pytest.mark.parametrize(
    ("line", "shown"),
    [
        ("  ::error::x", "  \\x3a:error::x"),
        ("::add-mask::x", "\\x3a:add-mask::x"),
        ("case ##[error]x", "case #\\x23[error]x"),
        ("  0.1  100 %", "  0.1  100 %"),
        ("", ""),
    ],
)
def test_a_line_of_the_log_is_no_command(line: str, shown: str) -> None:
    assert no_command(line) == shown


def test_a_notice_is_an_annotation_of_its_own_level() -> None:
    assert annotation("a.yaml", "sweep", "done", level="notice") == "::notice file=a.yaml,title=sweep::done"
