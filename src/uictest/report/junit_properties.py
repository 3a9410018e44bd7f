"""Properties of JUnit suites and testcases: controllers from outside, requirements, ids of test cases."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import Final

from uictest.judging import evaluation

WITH_TEST_PROPERTIES: Final = "junit-properties.xml"
"""Name of the file whose testcases have properties, which the schema of Jenkins' xUnit plugin forbids."""

_REQUIREMENT_SEPARATOR: Final = ","


def suite_properties(
    program: evaluation.Program | None,
    told: Iterable[str] = (),
    requirements: Iterable[str] = (),
    built_in: Iterable[str] = (),
    uictest_version: str = "",
) -> dict[str, str]:
    """Return what is known of the cases of a suite: their controller and the requirements that they verify.

    Without a program `built_in` names the controllers of the cases, which have the version of uictest. The
    properties are `controller` and, where known, `controller.kind`, `.source`, `.version` and `.sha256`.
    `told` has the versions that the program said of itself in the cases of the suite, empty where it said
    none. Where its scenario or file states another one, they are `controller.told_version`.
    """
    names = ", ".join(dict.fromkeys(filter(None, built_in)))
    version = f"uictest {uictest_version}" if names and uictest_version else ""
    own = {"controller": names, "controller.version": version}
    named = own if program is None else _program_facts(program, told)
    return named | {"requirements": _REQUIREMENT_SEPARATOR.join(requirements)}


def test_properties(test_case: str, requirements: Iterable[str] = ()) -> dict[str, str]:
    """Return the properties by which test management tools know a testcase, those without a value left out.

    Polarion reads `polarion-testcase-id`, Xray `test_key` and `requirements`.
    """
    joined = _REQUIREMENT_SEPARATOR.join(requirements)
    named = {"polarion-testcase-id": test_case, "test_key": test_case, "requirements": joined}
    return {name: value for name, value in named.items() if value}


def _program_facts(program: evaluation.Program, told: Iterable[str]) -> dict[str, str]:
    facts = dataclasses.asdict(program.telling(", ".join(filter(None, told))))
    return {"controller": facts.pop("name"), **{f"controller.{name}": text for name, text in facts.items()}}
