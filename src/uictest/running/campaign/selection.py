"""Select cases by expression, by tag or by id."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence

from uictest import report
from uictest.plans import scenario
from uictest.plans.scenario import Case, ExternalController, Scenario, is_changed, yaml

Matches = Callable[[str], bool]
"""Whether a case matches one word."""

Expression = Callable[[Matches], bool]

_TOKEN = re.compile(r"\s*([()]|[^\s()]+)")
_DEEPEST = 50


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


def descriptions_of(cases: Iterable[Case]) -> dict[str, report.CaseDescription]:
    """Return the description of every case by its id."""
    return {case.id: description_of(case.scenario) for case in cases}


def description_of(scenario: Scenario) -> report.CaseDescription:
    """Return title, tags and the main settings of a scenario."""
    return report.CaseDescription(scenario.title, tuple(scenario.tags), _settings(scenario))


def _settings(scenario: Scenario) -> dict[str, str]:
    brake, rail, rig = scenario.brake, scenario.rail, scenario.rig
    return {
        "vehicle": _named(scenario.vehicle),
        "initial speed": scenario.initial_speed.text,
        "brake": f"{_named(brake.system)}, position {brake.position}, {brake.command.text}",
        "rail": f"{_named(rail.condition)}, friction {_friction(scenario)}, gradient {rail.gradient.text}",
        "WSP": f"{rig.wsp}, controller {_controller(scenario)}",
        "rig": f"{rig.topology}, compensation {_named(rig.compensation_model)}, setting {rig.compensation}",
        "criteria": ", ".join(profile.name for profile in scenario.criteria),
    }


def _named(part: yaml.Part) -> str:
    """Return the name of a part, and whether it differs from the part that it extends."""
    return f"{part.label} (changed)" if is_changed(part) else part.label


def _friction(scenario: Scenario) -> str:
    rail = scenario.rail
    if rail.friction is None:
        text = rail.condition.friction.text
    else:
        text = getattr(rail.friction, "text", "along the track")
    return text if rail.friction_over_time is None else f"{text}, changing with time"


def _controller(scenario: Scenario) -> str:
    """Return the name of the controller; of one from outside, its version and what is loaded, too."""
    controller = scenario.controller
    if not isinstance(controller, ExternalController):
        return _named(controller)
    version = f" {controller.version}" if controller.version else ""
    return f"{_named(controller)}{version} ({controller.kind} {controller.reference})"
