"""What a check has found."""

from dataclasses import dataclass
from typing import Final, Literal

Status = Literal["not_checked", "pass", "warning", "fail", "error"]
SEVERITY: Final[tuple[Status, ...]] = ("not_checked", "pass", "warning", "fail", "error")
"""From the least to the worst."""
Group = Literal["numerics", "physics", "lanes", "judging", "controllers", "environment"]


@dataclass(frozen=True, slots=True)
class Finding:
    """The outcome of one check.

    Attributes:
        id: name of the check.
        group: what it is about.
        what: whose answer is known, in words.
        status: `error` where the check itself failed; `warning` is no failure.
        expected: the known answer: a number in `unit`, or a text; None where there is none.
        found: the answer of this installation.
        tolerance: largest difference that passes, as a share of `expected`; 0: none.
        unit: of numbers.
        reason: what differs, or why it was not checked.
    """

    id: str
    group: Group
    what: str
    status: Status
    expected: float | str | None
    found: float | str | None
    tolerance: float
    unit: str
    reason: str = ""
