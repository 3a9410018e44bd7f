"""JUnit XML of any result that has testcases; properties by which Polarion, Xray and people know these."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from typing import Final
from xml.etree import ElementTree

from uictest.core.document import Suite, Testcase
from uictest.judging import evaluation
from uictest.report.escaping import xml_text

WITH_TEST_PROPERTIES: Final = "junit-properties.xml"
"""Name of the file whose testcases have properties, which the schema of Jenkins' xUnit plugin forbids."""
_REQUIREMENT_SEPARATOR: Final = ","
_COUNTS: Final = (("failures", "failure"), ("errors", "error"), ("skipped", "skipped"))


def junit_text(suites: Iterable[Suite]) -> str:
    """Return suites as a JUnit document, characters that XML forbids left out.

    It keeps to the schema that Jenkins' xUnit plugin checks against, which has no `file` of a testcase; and
    no properties of one either, so that suites whose testcases have some go into a file of their own.
    """
    root = ElementTree.Element("testsuites")
    root.extend(map(_suite, suites))
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="utf-8"?>\n{ElementTree.tostring(root, encoding="unicode")}\n'


def _suite(suite: Suite) -> ElementTree.Element:
    statuses = [each.status for each in suite.testcases]
    counts = {name: str(statuses.count(tag)) for name, tag in _COUNTS}  # type: ignore[arg-type]
    attributes = {"name": xml_text(suite.name), "tests": str(len(statuses)), **counts}
    element = ElementTree.Element("testsuite", attributes | _time(suite.duration))
    _add_properties(element, suite.properties)
    element.extend(map(_testcase, suite.testcases))
    return element


def _testcase(testcase: Testcase) -> ElementTree.Element:
    names = {"classname": xml_text(testcase.class_name), "name": xml_text(testcase.name)}
    element = ElementTree.Element("testcase", names | _time(testcase.duration))
    _add_properties(element, testcase.properties)
    lines = [xml_text(line) for line in testcase.lines]
    if testcase.status != "passed":
        kind = {"type": testcase.kind} if testcase.kind else {}
        child = ElementTree.SubElement(element, testcase.status, {"message": lines[0], **kind})
        # GitLab shows the text and ignores the message, so the text has to say everything.
        child.text = "\n".join(lines)
    elif lines:
        ElementTree.SubElement(element, "system-out").text = "\n".join(lines)
    return element


def _time(duration: float | None) -> dict[str, str]:
    return {} if duration is None else {"time": f"{duration:.3f}"}


def _add_properties(element: ElementTree.Element, named: Mapping[str, str]) -> None:
    told = {name: text for name, text in named.items() if text}
    if told:
        properties = ElementTree.SubElement(element, "properties")
        for name, text in told.items():
            ElementTree.SubElement(properties, "property", name=xml_text(name), value=xml_text(text))


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
