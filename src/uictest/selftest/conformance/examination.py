"""Check a controller, and what was found."""

from collections.abc import Sequence

from uictest.controllers import ControllerError
from uictest.selftest.conformance.bench import Bench
from uictest.selftest.conformance.checks import CHECKS, Check
from uictest.selftest.conformance.subject import Subject
from uictest.selftest.finding import Examination, Finding, Status


def examine(subject: Subject, checks: Sequence[Check] = CHECKS) -> Examination:
    """Check a controller; a crash, a hang or an exception of it is a finding with the status `error`."""
    with Bench(subject) as bench:
        findings = tuple(_finding(check, bench, subject.name) for check in checks)
        about = {f"controller.{name}": text for name, text in subject.description.items()}
        about["controller.version"] = bench.version
        return Examination("controller check", _title(subject, bench.version), about, findings)


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
