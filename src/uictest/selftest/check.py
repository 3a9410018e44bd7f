"""What a check of the installation is: a question with a known answer."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple

from uictest.selftest.known_stops import KnownStops

Group = Literal["numerics", "physics", "lanes", "judging", "controllers", "environment"]


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
