"""Testcases as JUnit XML."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final
from xml.etree import ElementTree

from uictest.core.document import Suite, Testcase
from uictest.report.words import xml_text

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
    statuses = [testcase.status for testcase in suite.testcases]
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
