"""Check a controller, and what was found."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

from uictest.controllers import ControllerError
from uictest.selftest.conformance.bench import Bench
from uictest.selftest.conformance.checks import CHECKS, Check
from uictest.selftest.conformance.subject import Subject

Status = Literal["pass", "warning", "skipped", "fail", "error"]
SEVERITY: Final[tuple[Status, ...]] = ("skipped", "pass", "warning", "fail", "error")
"""From the least to the worst."""


@dataclass(frozen=True, slots=True)
class Finding:
    """The outcome of one check.

    Attributes:
        id: name of the check.
        requirement: the sentence that it checks.
        status: `error` where the controller did not answer; `warning` is no failure.
        value: what was found, in `unit`; None where nothing was.
        limit: largest value that passes.
        unit: of both.
        reason: what was found, in words.
    """

    id: str
    requirement: str
    status: Status
    value: float | None
    limit: float
    unit: str
    reason: str = ""


@dataclass(frozen=True, slots=True)
class Examination:
    """A controller and what the checks have found."""

    subject: Subject
    version: str
    findings: tuple[Finding, ...]

    @property
    def status(self) -> Status:
        """The worst of the findings."""
        return max((finding.status for finding in self.findings), key=SEVERITY.index)


def examine(subject: Subject, checks: Sequence[Check] = CHECKS) -> Examination:
    """Check a controller; a crash, a hang or an exception of it is a finding with the status `error`."""
    with Bench(subject) as bench:
        findings = tuple(_finding(check, bench) for check in checks)
        return Examination(subject, bench.version, findings)


def _finding(check: Check, bench: Bench) -> Finding:
    try:
        value, words = check.observe(bench)
    except ControllerError as error:
        return Finding(check.id, check.requirement, "error", None, check.limit, check.unit, str(error))
    status = _status(check, value)
    return Finding(check.id, check.requirement, status, value, check.limit, check.unit, words)


def _status(check: Check, value: float | None) -> Status:
    if value is None:
        return "skipped"
    if value <= check.limit:
        return "pass"
    return "warning" if check.advisory else "fail"
