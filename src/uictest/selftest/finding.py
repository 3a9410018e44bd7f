"""What checks have found of an installation or a controller."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, Literal

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


@dataclass(frozen=True, slots=True)
class Examination:
    """What was examined and what the checks have found.

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
