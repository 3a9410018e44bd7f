"""A controller examined by the checks."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from uictest.controllers import ControllerError
from uictest.selftest.conformance.bench import Answers, Bench, Subject
from uictest.selftest.conformance.checks import CHECKS, Check
from uictest.selftest.findings import Examination, Finding, Status


class Examined(NamedTuple):
    """What a check of a controller has found, and the situations of each check that is missed, by its id."""

    examination: Examination
    missed: Mapping[str, Mapping[str, Answers]]


def examine(subject: Subject, checks: Sequence[Check] = CHECKS) -> Examination:
    """Check a controller; a crash, a hang or an exception of it is a finding with the status `error`."""
    return examined(subject, checks).examination


def examined(subject: Subject, checks: Sequence[Check] = CHECKS) -> Examined:
    """Check a controller and keep what it has answered where it misses a check."""
    findings, missed = [], {}
    with Bench(subject) as bench:
        for check in checks:
            if check.contract > bench.contract:
                continue
            bench.asked = {}
            finding = _finding(check, bench, subject.name)
            findings.append(finding)
            if finding.status in ("fail", "error") and bench.asked:
                missed[check.id] = bench.asked
        about = {f"controller.{name}": text for name, text in subject.description.items()}
        about["controller.version"] = bench.version
        title = _title(subject, bench.version)
    return Examined(Examination("controller check", title, about, tuple(findings)), missed)


def _title(subject: Subject, version: str) -> str:
    described = subject.description
    told = f", version {version}" if version else ""
    digest = f", SHA-256 {described['sha256'][:12]}" if "sha256" in described else ""
    return f"controller {described['name']} ({described['kind']}{told}{digest})"


def _finding(check: Check, bench: Bench, controller: str) -> Finding:
    try:
        value, words = check.observe(bench)
        status = _status(check, value)
    except ControllerError as error:
        value, words, status = None, str(error), "error"
    return Finding(
        *(check.id, controller, check.requirement, status),
        expected=check.limit,
        found=value,
        tolerance=None,
        unit=check.unit,
        reason=words,
    )


def _status(check: Check, value: float | None) -> Status:
    if value is None:
        return "skipped"
    if value <= check.limit:
        return "pass"
    return "warning" if check.advisory else "fail"
