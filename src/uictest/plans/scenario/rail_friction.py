"""Detects a changed rail condition beside an unchanged rail.friction, which would silently override it."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from typing import Final

from uictest.plans.scenario.expansion import EXPANSION_KEYS
from uictest.plans.scenario.overrides import Override, with_value
from uictest.plans.scenario.resolution import PART_KEYS
from uictest.plans.scenario.yaml import (
    COMMAND_LINE,
    Diagnostic,
    Entry,
    Map,
    Node,
    Scalar,
    ScenarioErrors,
    Sequence as List,
    as_written,
    diagnose,
    quoted,
    visible,
)

FRICTION: Final = "rail.friction"
CONDITION: Final = "rail.condition"
_CONDITION: Final = ("rail", "condition")


def sets_friction(key: str) -> bool:
    """Whether a dotted key is that of the friction or lies inside it."""
    return f"{key}.".startswith(f"{FRICTION}.")


def changed_alone(before: Map, after: Map) -> Iterator[Diagnostic]:
    """Yield a change of the condition from ``before`` to ``after`` that leaves `rail.friction` as it was.

    A friction of the command line is meant for every case.
    """
    friction = _at(after, "rail", "friction")
    of_command_line = friction is not None and friction.place.document.display == COMMAND_LINE
    if friction is _at(before, "rail", "friction") and not of_command_line:
        yield from _conflict(before, after, friction)


def overridden_alone(tree: Map, overrides: Sequence[Override]) -> Iterator[Diagnostic]:
    """Yield the overrides of the condition that leave a friction of the file in force, swept or not."""
    if any(sets_friction(override.key) for override in overrides):
        return
    swept = (each for section in EXPANSION_KEYS[:-1] for each in _frictions(tree.get(section)))
    friction = next(swept, _at(tree, "rail", "friction"))
    for override in overrides:
        if override.key.startswith(CONDITION):
            for value in override.values:
                with suppress(ScenarioErrors):  # reported where it is applied
                    changed = with_value(tree, override.key, Entry(override.place, value))
                    yield from _conflict(tree, changed, friction)


def _conflict(before: Map, after: Map, friction: Node | None) -> Iterator[Diagnostic]:
    condition = _at(after, *_CONDITION)
    if friction is None or condition is None or (isinstance(friction, Scalar) and friction.value is None):
        return
    if _surface(condition) != _surface(_at(before, *_CONDITION)):
        written = friction.place
        yield diagnose(
            condition.place,
            f"the rail condition changes, but rail.friction stays {quoted(as_written(friction))}"
            f" ({visible(written.document.display)}:{written.line})",
            CONDITION,
            "set rail.friction as well; null takes the friction of the condition",
        )


def _surface(condition: Node | None) -> tuple[str, str]:
    """Name and friction of a condition; its other numbers hold for any friction."""
    if condition is None:
        return PART_KEYS[_CONDITION].default, ""
    if not isinstance(condition, Map):
        return as_written(condition), ""
    return _text(condition.get("extends")), _text(condition.get("friction"))


def _text(node: Node | None) -> str:
    return "" if node is None else as_written(node)


def _frictions(section: Node | None) -> Iterable[Node]:
    if isinstance(section, List):
        return (friction for item in section.items for friction in _frictions(item))
    return (
        [section.entries[FRICTION].node] if isinstance(section, Map) and FRICTION in section.entries else []
    )


def _at(node: Node | None, *key: str) -> Node | None:
    for element in key:
        node = node.get(element) if isinstance(node, Map) else None
    return node
