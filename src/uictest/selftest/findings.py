"""What checks have found: on a terminal, as JSON and as JUnit."""

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Final, Literal

from uictest.core.document import Column, Document, Lines, Suite, Table, Testcase, TestcaseStatus
from uictest.report import counted

Status = Literal["skipped", "pass", "warning", "fail", "error"]
SEVERITY: Final[tuple[Status, ...]] = ("skipped", "pass", "warning", "fail", "error")
"""From the least to the worst."""
Answer = float | str | None


@dataclass(frozen=True, slots=True)
class Finding:
    """The outcome of one check.

    Attributes:
        id: name of the check.
        group: what it is about: a field of physics or of the program; the controller.
        requirement: the sentence that it checks, or whose answer is known.
        status: `error` where the check itself or the controller failed; `warning` is no failure.
        expected: the known answer or the largest value that passes: a number in `unit`, or a text.
        found: the answer that was given; None where there was none.
        tolerance: largest difference that passes as a share of `expected`, 0: none; None where any value up
            to `expected` passes.
        unit: of numbers.
        reason: what differs, or why it was skipped.
        origin: where the known answer comes from; empty for a controller, which is held to a contract.
    """

    id: str
    group: str
    requirement: str
    status: Status
    expected: Answer
    found: Answer
    tolerance: float | None
    unit: str
    reason: str = ""
    origin: str = ""


@dataclass(frozen=True, slots=True)
class Examination:
    """The examined object and the findings of the checks.

    Attributes:
        kind: how it was examined.
        title: one line that says which; empty where `about` says it.
        about: facts by name: versions, processor; of a controller kind and SHA-256.
        findings: one for each check.
    """

    kind: Literal["selftest", "controller check"]
    title: str
    about: Mapping[str, str]
    findings: tuple[Finding, ...]

    @property
    def status(self) -> Status:
        """The worst of the findings."""
        return max((finding.status for finding in self.findings), key=SEVERITY.index)


SCHEMA: Final = "uictest/selftest/2"
_TAGS: Final[Mapping[str, TestcaseStatus]] = {"fail": "failure", "error": "error", "skipped": "skipped"}


_COLUMNS: Final[tuple[Column[Finding], ...]] = (
    Column(heading="check", text=lambda finding: finding.id),
    Column(heading="verdict", text=lambda finding: finding.status),
    Column(heading="expected", text=lambda finding: _expected_in_words(finding), rank=1, right=True),
    Column(
        heading="found", text=lambda finding: _answer_in_words(finding, finding.found), rank=1, right=True
    ),
    Column(
        heading="within",
        text=lambda finding: f"{100.0 * finding.tolerance:.3g} %" if finding.tolerance else "exact",
        rank=3,
        right=True,
    ),
    Column(heading="unit", text=lambda finding: finding.unit, rank=2),
    Column(heading="requirement", text=lambda finding: finding.requirement, rank=3),
)


def finding_document(examination: Examination) -> Document:
    """Return the examined object, a table of findings, and remarks on those that did not pass."""
    facts = [f"{name}: {text}" for name, text in examination.about.items() if text]
    heads = [examination.title] if examination.title else facts
    is_equal = any(finding.tolerance is not None for finding in examination.findings)
    columns = [column for column in _COLUMNS if is_equal or column.heading != "within"]
    table = Table(columns, examination.findings, all_in="--format json")
    return Document(examination.title, [Lines(heads), table, Lines(list(_lines_of_remarks(examination)))])


def _lines_of_remarks(examination: Examination) -> Iterator[str]:
    for finding in examination.findings:
        if finding.status != "pass":
            yield f"{finding.status} {finding.id}: {finding.reason or finding.requirement}"
    statuses = [finding.status for finding in examination.findings]
    counts = [f"{statuses.count(status)} {status}" for status in SEVERITY if status in statuses]
    yield f"{counted(len(statuses), 'check')}: {', '.join(counts)}"


def findings_json(examination: Examination) -> str:
    """Return the examined object and the findings as JSON; NaN and infinite numbers are null."""
    content = {
        "schema": SCHEMA,
        "kind": examination.kind,
        "status": examination.status,
        "about": dict(examination.about),
        "checks": [
            {
                **{name: value for name, value in asdict(finding).items() if value or name != "origin"},
                "expected": _finite_or_none(finding.expected),
                "found": _finite_or_none(finding.found),
            }
            for finding in examination.findings
        ],
    }
    return json.dumps(content, indent=2, allow_nan=False)


def findings_suite(examination: Examination) -> Suite:
    """Return one testcase per check."""
    prefix = "uictest.selftest." if examination.kind == "selftest" else ""
    testcases = []
    for finding in examination.findings:
        found = f"{_answer_in_words(finding, finding.found)} {finding.unit}".rstrip()
        sentence = f"{finding.requirement}: expected {_expected_in_words(finding)}, found {found}"
        lines = [finding.reason, sentence] if finding.reason else [sentence]
        status = _TAGS.get(finding.status, "passed")
        testcases.append(Testcase(f"{prefix}{finding.group}", finding.id, status, lines))
    return Suite(f"uictest {examination.kind}", testcases, properties=examination.about)


def _finite_or_none(value: Answer) -> Answer:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _expected_in_words(finding: Finding) -> str:
    return f"{'at most ' if finding.tolerance is None else ''}{_answer_in_words(finding, finding.expected)}"


def _answer_in_words(finding: Finding, value: Answer) -> str:
    if value is None or isinstance(value, str):
        return value or "-"
    if math.isinf(value):
        return "never"
    return f"{value:.3g}" if finding.tolerance is None else f"{value:.10g}"
