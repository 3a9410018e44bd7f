"""What of a case lies outside of the domain in which a model was validated."""

from __future__ import annotations

from dataclasses import dataclass

Found = str | tuple[float, float] | None
"""A setting or the name of a part; the lowest and the highest value of a number, SI; None: it is not set."""


@dataclass(frozen=True, slots=True)
class Deviation:
    """One condition of a case that none of the validated stops had.

    Args:
        key: of the scenario, or of a part.
        found: in the case.
        validated: among the validated stops that come nearest to it.
        unit: of numbers, SI.

    """

    key: str
    found: Found
    validated: Found
    unit: str = ""


@dataclass(frozen=True, slots=True)
class DomainOfValidity:
    """Whether a case lies in the domain of a validation: then nothing is `outside`.

    Args:
        validation: its name.
        sha256: of its file.
        outside: every condition beyond it.

    """

    validation: str
    sha256: str
    outside: tuple[Deviation, ...] = ()
