"""The parts that cases were run with in words: what each part is called, and what was changed in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from uictest.report.escaping import printable

if TYPE_CHECKING:
    from uictest.evaluation import EffectivePart, Parameter

_PATHS = (".yaml", ".yml")


def part_sentence(part: EffectivePart) -> str:
    """Return name and changes: `threshold, changed: slip_threshold 3 km/h (library: 1.146 m/s)`."""
    changes = "; ".join(_changes(part, part.key))
    return printable(", changed: ".join(text for text in (part.name or part.kind, changes) if text))


def changed_parameters(parts: Mapping[str, EffectivePart]) -> list[str]:
    """Return what differs from the library in a case: `controller.slip_threshold 3 km/h (library: ...)`.

    What the scenario says itself is held against its defaults.
    """
    return [printable(change) for part in parts.values() for change in _changes(part, "")]


def _changes(part: EffectivePart, above: str) -> Iterator[str]:
    for parameter in part.changed:
        key = parameter.key.removeprefix(f"{above}.")
        yield f"{key} {parameter.written} ({_base(part)}: {_library(parameter)})"
    for key in part.removed:
        yield f"{key.removeprefix(f'{above}.')} removed"


def _base(part: EffectivePart) -> str:
    """Return what the part it is based on is called."""
    if part.based_on is None:
        return "default"
    return part.based_on if part.based_on.endswith(_PATHS) else "library"


def _library(parameter: Parameter) -> str:
    return parameter.library_written or "none"
