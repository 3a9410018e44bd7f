"""What a check has found."""

from dataclasses import dataclass
from typing import Final, Literal

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
