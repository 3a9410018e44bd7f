"""Ask every question."""

from collections.abc import Sequence

from uictest.selftest.air import AIR_CHECKS
from uictest.selftest.bits import controller_checks, stop_checks
from uictest.selftest.check import Answer, Check, NotCheckedError
from uictest.selftest.dry_stop import DRY_STOP_CHECKS
from uictest.selftest.environment import environment, environment_checks
from uictest.selftest.finding import Examination, Finding, Status
from uictest.selftest.friction import CONTACT_CHECKS, FRICTION_CHECKS
from uictest.selftest.judging import judging_checks
from uictest.selftest.known_stops import KnownStops
from uictest.selftest.package_data import data_checks
from uictest.selftest.reference import reference_version


def all_checks(stops: KnownStops) -> tuple[Check, ...]:
    """Return all checks; those of stored stops are asked of `stops`."""
    return (
        *stop_checks(stops),
        *DRY_STOP_CHECKS,
        *AIR_CHECKS,
        *CONTACT_CHECKS,
        *FRICTION_CHECKS,
        *judging_checks(),
        *controller_checks(),
        *data_checks(),
        *environment_checks(),
    )


def examine(stops: KnownStops, checks: Sequence[Check] | None = None) -> Examination:
    """Ask every question, or these; an exception in a check is a finding with the status `error`."""
    asked = all_checks(stops) if checks is None else checks
    about = {**environment(), "stored stops": f"computed by uictest {reference_version()}"}
    return Examination("selftest", "", about, tuple(_finding(check, stops) for check in asked))


def _finding(check: Check, stops: KnownStops) -> Finding:
    try:
        answer = check.answer(stops)
    except NotCheckedError as error:
        return _without_answer(check, "skipped", str(error))
    except Exception as error:
        return _without_answer(check, "error", f"{type(error).__name__}: {error}")
    status = _status(check, answer)
    described = check.id, check.group, check.what
    return Finding(
        *described, status, answer.expected, answer.found, check.tolerance, check.unit, answer.words
    )


def _without_answer(check: Check, status: Status, reason: str) -> Finding:
    return Finding(check.id, check.group, check.what, status, None, None, check.tolerance, check.unit, reason)


def _status(check: Check, answer: Answer) -> Status:
    if _agree(answer.expected, answer.found, check.tolerance):
        return "pass"
    return "warning" if check.advisory else "fail"


def _agree(expected: float | str, found: float | str, tolerance: float) -> bool:
    if isinstance(expected, str) or isinstance(found, str):
        return expected == found
    # Not `>`: a number that is none must not pass.
    return abs(found - expected) <= tolerance * abs(expected)
