"""JUnit XML: one testcase per case, the explanation as the element's text."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath
from typing import TYPE_CHECKING
from xml.etree import ElementTree

from uictest.report.escaping import xml_text
from uictest.report.wording import explanation

if TYPE_CHECKING:
    from uictest.evaluation import CaseResult


def junit_xml(results: Sequence[CaseResult]) -> str:
    """Return the results as a JUnit document, characters that XML forbids left out.

    It keeps to the schema that Jenkins' xUnit plugin checks against, which knows no `file` of a testcase.
    """
    root = ElementTree.Element("testsuites")
    suite = ElementTree.SubElement(root, "testsuite", name="uictest", tests=str(len(results)))
    for result in results:
        suite.append(_testcase(result))
    for name, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(name, str(len(suite.findall(f"testcase/{tag}"))))
    suite.set("time", f"{sum(result.duration for result in results):.3f}")
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="utf-8"?>\n{ElementTree.tostring(root, encoding="unicode")}\n'


def _testcase(result: CaseResult) -> ElementTree.Element:
    element = ElementTree.Element(
        "testcase",
        classname=xml_text(_dotted(result.scenario)),
        name=xml_text(result.id),
        time=f"{result.duration:.3f}",
    )
    tag = _child_tag(result)
    if tag is not None:
        lines = [xml_text(line) for line in explanation(result)]
        child = ElementTree.SubElement(element, tag, message=lines[0])
        # GitLab shows the text and ignores the message, so the text has to say everything.
        child.text = "\n".join(lines)
    return element


def _child_tag(result: CaseResult) -> str | None:
    if result.outcome == "error":
        return "error"
    if not result.met:
        return "failure"
    return "skipped" if result.outcome == "skipped" else None


def _dotted(scenario: str) -> str:
    path = PurePosixPath(scenario)
    return ".".join(part for part in path.with_suffix("").parts if part not in ("/", "..", "."))
