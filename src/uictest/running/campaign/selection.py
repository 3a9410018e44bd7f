"""Select cases by expression, by tag or by id."""

from __future__ import annotations

from collections.abc import Sequence

from uictest.plans import scenario
from uictest.running.campaign.expression import parse


def by_expression(cases: Sequence[scenario.Case], expression: str) -> list[scenario.Case]:
    """Return the cases that match an expression: a word matches inside the id, the file name or a tag.

    Case is ignored. Raises ExpressionError.
    """
    holds = parse(expression)
    return [case for case in cases if holds(lambda word, case=case: _mentions(case, word))]  # type: ignore[misc]


def by_tag(cases: Sequence[scenario.Case], expression: str) -> list[scenario.Case]:
    """Return the cases that match an expression over whole tags, e.g. `slip` or `slip and not long`.

    Raises ExpressionError.
    """
    holds = parse(expression)
    return [case for case in cases if holds(frozenset(case.scenario.tags).__contains__)]


def by_id(cases: Sequence[scenario.Case], ids: frozenset[str]) -> list[scenario.Case]:
    """Return the cases whose id is among `ids`, in their own order."""
    return [case for case in cases if case.id in ids]


def _mentions(case: scenario.Case, word: str) -> bool:
    sought = word.casefold()
    return any(sought in name.casefold() for name in (case.id, case.path.stem, *case.scenario.tags))
