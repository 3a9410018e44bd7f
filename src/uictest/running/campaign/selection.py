"""Select cases and series by expression, by tag or by id."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from uictest.plans.scenario import Case
    from uictest.plans.series import Series

Matches = Callable[[str], bool]
"""Whether a case matches one word."""

Expression = Callable[[Matches], bool]

_TOKEN = re.compile(r"\s*([()]|[^\s()]+)")
_VALUE = re.compile(r"=[^][,=]+$")
"""A value at the end of a word, as ids have them."""
_END_OF_VALUE = r"(?:(?<=\d)(?!e[+-]?\d)[^\W\d_]\w*)?(?=[],]|$)"
"""What follows a whole value: its unit, if it is a number, and the end."""
_DEEPEST = 50
"""Parentheses inside each other that are read; chosen, far within what the interpreter can nest."""


class ExpressionError(ValueError):
    """A selection expression that cannot be read; the message says where and what was expected."""


def parse(text: str) -> Expression:
    """Return the predicate that an expression stands for; an empty expression matches everything.

    `not` binds closer than `and`, `and` closer than `or`. Raises ExpressionError.
    """
    tokens = [(match.group(1), match.start(1) + 1) for match in _TOKEN.finditer(text)]
    if not tokens:
        return lambda matches: True
    return _Reader(tokens, end=len(text) + 1).expression()


class _Reader:
    """Reads tokens from left to right, one method per rule of the grammar."""

    def __init__(self, tokens: list[tuple[str, int]], end: int) -> None:
        self._tokens = tokens
        self._end = end
        self._next = 0
        self._depth = 0

    def expression(self) -> Expression:
        result = self._either()
        if self._peek() is not None:
            raise self._unexpected("'and', 'or' or the end")
        return result

    def _either(self) -> Expression:
        parts = [self._both()]
        while self._accept("or"):
            parts.append(self._both())
        return parts[0] if len(parts) == 1 else lambda matches: any(part(matches) for part in parts)

    def _both(self) -> Expression:
        parts = [self._negated()]
        while self._accept("and"):
            parts.append(self._negated())
        return parts[0] if len(parts) == 1 else lambda matches: all(part(matches) for part in parts)

    def _negated(self) -> Expression:
        negations = 0
        while self._accept("not"):
            negations += 1
        operand = self._operand()
        return (lambda matches: not operand(matches)) if negations % 2 else operand

    def _operand(self) -> Expression:
        if self._accept("("):
            return self._enclosed()
        word = self._peek()
        if word is None or word in (")", "and", "or"):
            raise self._unexpected("a word, 'not' or '('")
        self._next += 1
        return lambda matches: matches(word)

    def _enclosed(self) -> Expression:
        self._depth += 1
        if self._depth > _DEEPEST:
            raise ExpressionError(f"more than {_DEEPEST} parentheses inside each other")
        inner = self._either()
        if not self._accept(")"):
            raise self._unexpected("')'")
        self._depth -= 1
        return inner

    def _peek(self) -> str | None:
        return self._tokens[self._next][0] if self._next < len(self._tokens) else None

    def _accept(self, token: str) -> bool:
        accepted = self._peek() == token
        self._next += accepted
        return accepted

    def _unexpected(self, expected: str) -> ExpressionError:
        if self._next == len(self._tokens):
            return ExpressionError(f"at column {self._end}: expected {expected}, found the end")
        word, column = self._tokens[self._next]
        return ExpressionError(f"at column {column}: expected {expected}, found {word!r}")


Selectable = TypeVar("Selectable", bound="Case | Series")


def by_expression(among: Iterable[Selectable], expression: str) -> list[Selectable]:
    """Return the cases or series that match an expression: a word matches inside id, file name or a tag.

    Case is ignored. Raises ExpressionError.
    """
    holds = parse(expression)
    return [each for each in among if holds(mentioned_in([each.id, each.path.stem, *_tags_of(each)]))]


def by_tag(among: Iterable[Selectable], expression: str) -> list[Selectable]:
    """Return the cases or series that match an expression over whole tags, e.g. `slip and not long`.

    Raises ExpressionError.
    """
    holds = parse(expression)
    return [each for each in among if holds(frozenset(_tags_of(each)).__contains__)]


def by_id(among: Iterable[Selectable], ids: frozenset[str]) -> list[Selectable]:
    """Return the cases or series whose id is among `ids`, in their own order."""
    return [each for each in among if each.id in ids]


def selected(
    among: Iterable[Selectable], expression: str | None = None, tag: str | None = None
) -> list[Selectable]:
    """Return the cases or series that an expression (`-k`) and tags (`-m`) select. Raises ExpressionError."""
    found = list(among) if expression is None else by_expression(among, expression)
    return found if tag is None else by_tag(found, tag)


def mentioned_in(names: Iterable[str]) -> Matches:
    """Return whether a word is in any of some names; case is ignored.

    Where a word ends in a value, as `car=1` does, that is the whole value: `car=10` is another one. Its unit
    may be left out.
    """
    folded = [name.casefold() for name in names]

    def matches(word: str) -> bool:
        folded_word = word.casefold()
        if not _VALUE.search(folded_word):
            return any(folded_word in name for name in folded)
        whole = re.compile(re.escape(folded_word) + _END_OF_VALUE)
        return any(whole.search(name) for name in folded)

    return matches


def _tags_of(each: Case | Series) -> Sequence[str]:
    return each.scenario.tags if hasattr(each, "scenario") else each.file.tags
