"""The findings as a document, as JSON and as testcases."""

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import Any, Final

from uictest.core.document import Column, Document, Lines, Suite, Table, Testcase, TestcaseStatus
from uictest.report import counted
from uictest.selftest.finding import SEVERITY, Answer, Examination, Finding

SCHEMA: Final = "uictest/selftest/2"
_TAGS: Final[Mapping[str, TestcaseStatus]] = {"fail": "failure", "error": "error", "skipped": "skipped"}


def _within(finding: Finding) -> str:
    return f"{finding.tolerance:.0e}" if finding.tolerance else "exact"


_COLUMNS: Final[tuple[Column[Finding], ...]] = (
    Column(heading="check", text=lambda each: each.id),
    Column(heading="verdict", text=lambda each: each.status),
    Column(heading="expected", text=lambda each: _expected(each), rank=1, right=True),
    Column(heading="found", text=lambda each: _text(each, each.found), rank=1, right=True),
    Column(heading="within", text=_within, rank=3, right=True),
    Column(heading="unit", text=lambda each: each.unit, rank=3),
    Column(heading="requirement", text=lambda each: each.requirement, rank=2),
)


def finding_document(examination: Examination) -> Document:
    """Return what was examined, a table of findings, and what was not as it should be."""
    facts = [f"{name}: {text}" for name, text in examination.about.items() if text]
    heads = [examination.title] if examination.title else facts
    is_equal = any(each.tolerance is not None for each in examination.findings)
    columns = [each for each in _COLUMNS if is_equal or each.heading != "within"]
    table = Table(columns, examination.findings, more="--format json has them")
    return Document(examination.title, [Lines(heads), table, Lines(list(_remarks(examination)))])


def _remarks(examination: Examination) -> Iterator[str]:
    for each in examination.findings:
        if each.status != "pass":
            yield f"{each.status} {each.id}: {each.reason or each.requirement}"
    statuses = [each.status for each in examination.findings]
    counts = [f"{statuses.count(each)} {each}" for each in SEVERITY if each in statuses]
    yield f"{counted(len(statuses), 'check')}: {', '.join(counts)}"


def findings_json(examination: Examination) -> str:
    """Return what was examined and the findings as JSON; a number that is none, or has no bound, is null."""
    content = {
        "schema": SCHEMA,
        "kind": examination.kind,
        "status": examination.status,
        "about": dict(examination.about),
        "checks": [_plain(each) for each in examination.findings],
    }
    return json.dumps(content, indent=2, allow_nan=False)


def findings_suite(examination: Examination) -> Suite:
    """Return one testcase per check."""
    prefix = "uictest.selftest." if examination.kind == "selftest" else ""
    testcases = [Testcase(f"{prefix}{each.group}", each.id, *_outcome(each)) for each in examination.findings]
    return Suite(f"uictest {examination.kind}", testcases, properties=examination.about)


def _outcome(finding: Finding) -> tuple[TestcaseStatus, list[str]]:
    answers = f"expected {_expected(finding)}, found {_text(finding, finding.found)} {finding.unit}".rstrip()
    lines = [finding.reason, f"{finding.requirement}: {answers}"]
    return _TAGS.get(finding.status, "passed"), [line for line in lines if line]


def _plain(finding: Finding) -> dict[str, Any]:
    return {**asdict(finding), "expected": _number(finding.expected), "found": _number(finding.found)}


def _number(value: Answer) -> Answer:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _expected(finding: Finding) -> str:
    return f"{'at most ' if finding.tolerance is None else ''}{_text(finding, finding.expected)}"


def _text(finding: Finding, value: Answer) -> str:
    if value is None or isinstance(value, str):
        return value or "-"
    if math.isinf(value):
        return "never"
    return f"{value:.3g}" if finding.tolerance is None else f"{value:.10g}"
