"""What the verdicts on a stop come to: whether it is a test, whether requirements are met, the outcome."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Annotated, Final, Literal

from uictest.judging.evaluation.json_values import BuiltWhenUsed, Outcome
from uictest.judging.evaluation.verdict import Layer, Status, Verdict, WrittenVerdict
from uictest.plans.scenario import Expectation

TestValidity = Literal["valid", "not_valid", "not_judged"]
"""Whether a stop is a test: `not_valid` where a criterion of validity or a check of rig or record fails."""
RequirementStatus = Literal["met", "missed", "not_judged"]
"""Whether all requirements on a stop are met; one that fails in a stop that is not a test is missed, too."""


@dataclass(frozen=True, slots=True)
class RailValidity:
    """Whether the rail itself makes a stop a test: verdicts on the same stop with the WSP bypassed.

    Args:
        criteria: those of validity.
        friction: coefficient of the rail as found, in words.
        wheels_lock: whether any wheelset locks for a second or more.
        decides: whether they decide in place of those of the stop with the WSP active.

    """

    criteria: tuple[WrittenVerdict, ...]
    friction: str
    wheels_lock: bool
    decides: bool

    @property
    def test_validity(self) -> TestValidity:
        """Whether the rail makes the stop a test."""
        return validity_of(self.criteria)


WrittenRailValidity = Annotated[RailValidity, BuiltWhenUsed(RailValidity)]


def decided_by(verdicts: tuple[Verdict, ...], rail: RailValidity | None) -> tuple[Verdict, ...]:
    """Return the verdicts that decide an outcome: those of the rail, if it does, in place of their own."""
    if rail is None or not rail.decides:
        return verdicts
    of_rail = {verdict.id: verdict for verdict in rail.criteria}
    return tuple(of_rail.get(verdict.id, verdict) for verdict in verdicts)


_CHECKS: Final[tuple[Layer, ...]] = ("rig", "record")
"""Layers whose failure says that the figures are not those of the test: it is never expected."""


def failed_checks(verdicts: Iterable[Verdict]) -> list[Verdict]:
    """Return the checks of the rig and of the record that fail."""
    return _with_status(verdicts, ("fail",), _CHECKS)


def validity_of(verdicts: Iterable[Verdict]) -> TestValidity:
    """Return whether a stop is a test; `not_judged` where no criterion of validity could say."""
    verdicts = list(verdicts)
    if _with_status(verdicts, ("fail",), (*_CHECKS, "validity")):
        return "not_valid"
    statuses = [verdict.status for verdict in verdicts if verdict.layer == "validity"]
    return "valid" if "pass" in statuses and "inconclusive" not in statuses else "not_judged"


def requirements_of(verdicts: Iterable[Verdict]) -> RequirementStatus:
    """Return whether all requirements that apply are met."""
    statuses = [verdict.status for verdict in verdicts if verdict.layer == "requirement"]
    if "fail" in statuses:
        return "missed"
    return "met" if "pass" in statuses and "inconclusive" not in statuses else "not_judged"


def why_no_test(verdicts: Iterable[Verdict]) -> list[Verdict]:
    """Return the verdicts by which a stop is not a test: checks and criteria of validity not shown to hold.

    A stop whose validity nothing judges counts.
    """
    verdicts = list(verdicts)
    failed = _with_status(verdicts, ("fail",), (*_CHECKS, "validity"))
    return failed or _with_status(verdicts, ("inconclusive",), ("validity",))


def missed_requirements(verdicts: Iterable[Verdict]) -> list[Verdict]:
    """Return the requirements that are missed and stand: some do so in a valid test alone."""
    verdicts = list(verdicts)
    no_test = bool(why_no_test(verdicts))
    failed = _with_status(verdicts, ("fail",), ("requirement",))
    return [each for each in failed if not (no_test and each.in_valid_test)]


def deciding_verdicts(verdicts: Iterable[Verdict]) -> tuple[Outcome, list[Verdict]]:
    """Return the outcome of a stop and the verdicts that decide it, none where it passes.

    The first that holds: `invalid` where a check of the rig or of the record fails, as the figures are not
    those of the test; `fail` where a requirement that stands is missed; `invalid` where a criterion of
    validity is missed; `inconclusive` where data to judge a criterion are missing; `skipped` where no
    criterion of validity or requirement could judge; `pass`.
    """
    verdicts = list(verdicts)
    if failed := failed_checks(verdicts):
        return "invalid", failed
    if failed := missed_requirements(verdicts):
        return "fail", failed
    if failed := _with_status(verdicts, ("fail",), ("validity",)):
        return "invalid", failed
    judging = [verdict for verdict in verdicts if verdict.layer not in _CHECKS]
    if _with_status(judging, ("inconclusive",)):
        return "inconclusive", _with_status(judging, ("fail", "inconclusive"))
    if not _with_status(judging, ("pass",)):
        return "skipped", _with_status(judging, ("not_applicable",))
    return "pass", []


def outcome_of(verdicts: Iterable[Verdict]) -> tuple[Outcome, str]:
    """Return the outcome of a stop and why."""
    outcome, deciding = deciding_verdicts(verdicts)
    return outcome, reasons_of(deciding) or ("no criterion" if outcome == "skipped" else "")


def reasons_of(verdicts: Iterable[Verdict]) -> str:
    """Return the reasons of verdicts, each after the id of its criterion."""
    return "; ".join(f"{verdict.id}: {verdict.reason}" for verdict in verdicts)


def is_expected(outcome: Outcome, verdicts: Iterable[Verdict], expect: Expectation) -> bool:
    """Return whether a stop came out as expected.

    Nothing that was not judged counts as `pass`. Where a check of the rig or of the record fails, nothing is
    expected. Of named criteria only those may be missed, and one at least must be, but under another
    controller than the one that they were named for.
    """
    verdicts = list(verdicts)
    if failed_checks(verdicts):
        return False
    if outcome not in ("fail", "invalid") or not expect.names_criteria:
        return outcome == expect.outcome or (expect.is_allowance and outcome == "pass")
    if _with_status(verdicts, ("inconclusive",), ("validity",)):
        return False
    missed = missed_requirements(verdicts), _with_status(verdicts, ("fail",), ("validity",))
    return all(
        {each.id for each in own} <= {*names} and (expect.is_allowance or bool(own) == bool(names))
        for own, names in zip(missed, (expect.fail, expect.invalid), strict=True)
    )


def _with_status(
    verdicts: Iterable[Verdict], statuses: Sequence[Status], layers: Sequence[Layer] = ()
) -> list[Verdict]:
    return [each for each in verdicts if each.status in statuses and (not layers or each.layer in layers)]
