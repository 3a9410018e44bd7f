"""The findings as a table, as JSON and as JUnit."""

import json
import math
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any, Final
from xml.etree import ElementTree

from uictest.report import TableColumn, aligned, columns_not_shown, fitted, printable, xml_text
from uictest.selftest.conformance.examination import Examination, Finding

SCHEMA: Final = "uictest/conformance/1"


def finding_table(examination: Examination, width: int | None) -> Iterator[str]:
    """Yield the controller, a table of findings in so many characters, and what was not as it should be."""
    yield f"controller {_described(examination)}"
    findings = examination.findings
    columns = [
        TableColumn("check", [each.id for each in findings]),
        TableColumn("verdict", [each.status for each in findings]),
        TableColumn("value", [_text(each.value) for each in findings], right=True),
        TableColumn("at most", [_text(each.limit) for each in findings], right=True),
        TableColumn("unit", [each.unit for each in findings], rank=1),
        TableColumn("requirement", [each.requirement for each in findings], rank=2),
    ]
    shown, hidden = fitted(columns, width)
    yield from aligned(shown)
    if hidden:
        yield columns_not_shown(hidden, "--format json has them")
    for each in findings:
        if each.status not in ("pass", "skipped"):
            yield f"{each.status} {each.id}: {printable(each.reason)}"


def findings_json(examination: Examination) -> str:
    """Return the controller and the findings as JSON; a value that has no bound is null."""
    findings = [_plain(each) for each in examination.findings]
    controller = {**examination.subject.description, "version": examination.version}
    return json.dumps({"schema": SCHEMA, "controller": controller, "checks": findings}, indent=2)


def junit_xml(examination: Examination) -> str:
    """Return the findings as a JUnit document, one testcase per check."""
    findings = examination.findings
    root = ElementTree.Element("testsuites")
    suite = ElementTree.SubElement(
        root, "testsuite", name="uictest controller check", tests=str(len(findings))
    )
    for name, status in (("failures", "fail"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(name, str(sum(each.status == status for each in findings)))
    _add_properties(suite, examination)
    for each in findings:
        suite.append(_testcase(each, examination.subject.name))
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="utf-8"?>\n{ElementTree.tostring(root, encoding="unicode")}\n'


def _add_properties(suite: ElementTree.Element, examination: Examination) -> None:
    properties = ElementTree.SubElement(suite, "properties")
    described = {**examination.subject.description, "version": examination.version}
    for name, value in described.items():
        ElementTree.SubElement(properties, "property", name=f"controller.{name}", value=xml_text(value))


def _testcase(finding: Finding, controller: str) -> ElementTree.Element:
    element = ElementTree.Element("testcase", classname=xml_text(controller), name=finding.id)
    text = xml_text(
        f"{finding.requirement} {_text(finding.value)}, at most {_text(finding.limit)}"
        f" {finding.unit}: {finding.reason}"
    )
    tags = {"fail": "failure", "error": "error", "skipped": "skipped"}
    if finding.status in tags:
        ElementTree.SubElement(element, tags[finding.status], message=xml_text(finding.reason)).text = text
    else:
        ElementTree.SubElement(element, "system-out").text = text
    return element


def _plain(finding: Finding) -> dict[str, Any]:
    unbounded = finding.value is None or math.isinf(finding.value)
    return {**asdict(finding), "value": None if unbounded else finding.value}


def _text(value: float | None) -> str:
    if value is None:
        return "-"
    return "never" if math.isinf(value) else f"{value:.3g}"


def _described(examination: Examination) -> str:
    described = examination.subject.description
    version = f", version {printable(examination.version)}" if examination.version else ""
    digest = f", SHA-256 {described['sha256'][:12]}" if "sha256" in described else ""
    return f"{printable(described['name'])} ({described['kind']}{version}{digest})"
