"""The findings as a table, as JSON and as JUnit."""

import json
import math
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any, Final
from xml.etree import ElementTree

from uictest.report import TableColumn, aligned, columns_not_shown, counted, fitted, printable, xml_text
from uictest.selftest.check import SEVERITY, Finding
from uictest.selftest.examination import Examination

SCHEMA: Final = "uictest/selftest/1"


def finding_table(examination: Examination, width: int | None) -> Iterator[str]:
    """Yield the installation, a table of findings in so many characters, and what was not as it should be."""
    for name, text in examination.environment.items():
        yield f"{name}: {printable(text)}"
    yield f"stored stops: computed by uictest {examination.reference}"
    findings = examination.findings
    columns = [
        TableColumn("check", [each.id for each in findings]),
        TableColumn("verdict", [_word(each) for each in findings]),
        TableColumn("expected", [_text(each.expected) for each in findings], rank=1, right=True),
        TableColumn("found", [_text(each.found) for each in findings], rank=1, right=True),
        TableColumn("within", [_within(each) for each in findings], rank=3, right=True),
        TableColumn("unit", [each.unit for each in findings], rank=3),
        TableColumn("known answer", [each.what for each in findings], rank=2),
    ]
    shown, hidden = fitted(columns, width)
    yield from aligned(shown)
    if hidden:
        yield columns_not_shown(hidden, "--format json has them")
    for each in findings:
        if each.status != "pass":
            yield f"{_word(each)} {each.id}: {printable(each.reason or each.what)}"
    yield _tally(examination)


def findings_json(examination: Examination) -> str:
    """Return the installation and the findings as JSON; a number that is none is null."""
    content = {
        "schema": SCHEMA,
        "status": examination.status,
        "environment": dict(examination.environment),
        "reference_version": examination.reference,
        "checks": [_plain(each) for each in examination.findings],
    }
    return json.dumps(content, indent=2, allow_nan=False)


def junit_xml(examination: Examination) -> str:
    """Return the findings as a JUnit document, one testcase per check."""
    findings = examination.findings
    root = ElementTree.Element("testsuites")
    suite = ElementTree.SubElement(root, "testsuite", name="uictest selftest", tests=str(len(findings)))
    for name, status in (("failures", "fail"), ("errors", "error"), ("skipped", "not_checked")):
        suite.set(name, str(sum(each.status == status for each in findings)))
    properties = ElementTree.SubElement(suite, "properties")
    for name, text in {**examination.environment, "reference": examination.reference}.items():
        ElementTree.SubElement(properties, "property", name=xml_text(name), value=xml_text(text))
    suite.extend(map(_testcase, findings))
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="utf-8"?>\n{ElementTree.tostring(root, encoding="unicode")}\n'


def _testcase(finding: Finding) -> ElementTree.Element:
    element = ElementTree.Element("testcase", classname=f"uictest.selftest.{finding.group}", name=finding.id)
    answers = f"expected {_text(finding.expected)}, found {_text(finding.found)} {finding.unit}".rstrip()
    text = xml_text(f"{finding.what}: {answers}. {finding.reason}".rstrip())
    tags = {"fail": "failure", "error": "error", "not_checked": "skipped"}
    if finding.status in tags:
        message = xml_text(finding.reason or answers)
        ElementTree.SubElement(element, tags[finding.status], message=message).text = text
    else:
        ElementTree.SubElement(element, "system-out").text = text
    return element


def _plain(finding: Finding) -> dict[str, Any]:
    return {**asdict(finding), "expected": _number(finding.expected), "found": _number(finding.found)}


def _number(value: float | str | None) -> float | str | None:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _text(value: float | str | None) -> str:
    if value is None:
        return "-"
    return printable(value) if isinstance(value, str) else f"{value:.10g}"


def _within(finding: Finding) -> str:
    return f"{finding.tolerance:.0e}" if finding.tolerance else "exact"


def _word(finding: Finding) -> str:
    return finding.status.replace("_", " ")


def _tally(examination: Examination) -> str:
    statuses = [each.status for each in examination.findings]
    counts = [f"{statuses.count(each)} {each.replace('_', ' ')}" for each in SEVERITY if each in statuses]
    return f"{counted(len(statuses), 'known answer')}: {', '.join(counts)}"
