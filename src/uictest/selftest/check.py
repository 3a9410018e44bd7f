"""What a check is, a question with a known answer, and what it has found."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Literal, NamedTuple

from uictest.selftest.known_stops import KnownStops

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


class NotCheckedError(Exception):
    """What a check needs is not there; the message says what."""


class Answer(NamedTuple):
    """The known answer and that of this installation, two numbers or two texts; in words how they differ."""

    expected: float | str
    found: float | str
    words: str = ""


@dataclass(frozen=True, slots=True)
class Check:
    """One question with a known answer.

    Attributes:
        id: its name.
        group: what it is about.
        what: whose answer is known, in words.
        answer: returns both answers. Raises NotCheckedError.
        tolerance: largest difference of two numbers that passes, as a share of the known one; 0: none.
        unit: of the numbers.
        advisory: whether another answer is only a warning.
    """

    id: str
    group: Group
    what: str
    answer: Callable[[KnownStops], Answer]
    tolerance: float = 0.0
    unit: str = ""
    advisory: bool = False
