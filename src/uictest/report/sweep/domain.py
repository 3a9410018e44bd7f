"""How many cases of a sweep lie outside of what was validated, and in what."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from uictest.judging.evaluation import Deviation
from uictest.report.domain_wording import deviation_text
from uictest.report.wording import counted

_MOST_NAMED: Final = 6
"""Conditions that a note lists before the rest is counted."""


@dataclass(frozen=True, slots=True)
class OutsideCount:
    """The cases beyond what was validated in one condition; of numbers, `found` spans all of theirs."""

    cases: int
    deviation: Deviation


@dataclass(frozen=True, slots=True)
class SweepDomain:
    """How many cases lie outside of the domain of a validation.

    Args:
        validation: its name.
        sha256: of its file.
        outside: number of cases with any condition beyond it.
        conditions: those conditions, the one of most cases first; a case may be in several.

    """

    validation: str
    sha256: str
    outside: int
    conditions: tuple[OutsideCount, ...] = ()


def domain_notes(domain: SweepDomain | None, cases: int) -> Iterator[str]:
    """Yield how many of `cases` lie outside, and in what; nothing where nobody asked."""
    if domain is None:
        return
    among = f"{domain.outside} of {counted(cases, 'case')} outside of what {domain.validation} validated"
    shown = [f"{deviation_text(each.deviation)} in {each.cases}" for each in domain.conditions[:_MOST_NAMED]]
    more = len(domain.conditions) - len(shown)
    rest = f"; {counted(more, 'more condition')} in sweep.json" if more else ""
    yield f"{among}: {'; '.join(shown)}{rest}" if shown else among
