"""The parameters that are not the same in two runs of a case."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from uictest import evaluation
from uictest.report import listed, printable

_ABSENT = "none"


@dataclass(frozen=True, slots=True)
class ParameterChange:
    """A parameter, or the name of a part, that differs between two runs, and the cases in which it does."""

    key: str
    first: str
    second: str
    cases: tuple[str, ...]

    def __str__(self) -> str:
        """Return the change for a reader: `controller.slip_threshold: 4 km/h -> 3 km/h`."""
        return f"{self.key}: {self.first} -> {self.second}"


def parameter_changes(
    pairs: Iterable[tuple[evaluation.CaseResult, evaluation.CaseResult]],
) -> list[ParameterChange]:
    """Return what differs in the parameters of pairs of cases, once for all cases alike.

    Cases whose results hold no parameters, as those of earlier versions, are skipped.
    """
    cases: dict[tuple[str, str, str], list[str]] = {}
    for first, second in pairs:
        if first.parts and second.parts:
            for change in _changes(first.parts, second.parts):
                cases.setdefault(change, []).append(first.id)
    return [ParameterChange(*change, tuple(ids)) for change, ids in cases.items()]


def parameter_lines(changes: Iterable[ParameterChange]) -> Iterator[str]:
    """Yield a line for each change, with the cases it is in."""
    for change in changes:
        yield printable(f"parameter {change} (in {listed(change.cases)})")


def _changes(
    first: Mapping[str, evaluation.EffectivePart], second: Mapping[str, evaluation.EffectivePart]
) -> Iterator[tuple[str, str, str]]:
    for role in dict.fromkeys([*first, *second]):
        ours, theirs = first.get(role), second.get(role)
        if ours is None or theirs is None or ours.id != theirs.id:
            yield from _of_part(role, ours, theirs)


def _of_part(
    role: str, first: evaluation.EffectivePart | None, second: evaluation.EffectivePart | None
) -> Iterator[tuple[str, str, str]]:
    names = [_ABSENT if part is None else part.name for part in (first, second)]
    if names[0] != names[1]:
        yield role, names[0], names[1]
    if first is None or second is None:
        return
    ours, theirs = ({each.key: each for each in part.parameters} for part in (first, second))
    for key in dict.fromkeys([*ours, *theirs]):
        one, other = ours.get(key), theirs.get(key)
        if one is None or other is None or (one.value, one.unit) != (other.value, other.unit):
            yield key, _written(one), _written(other)


def _written(parameter: evaluation.Parameter | None) -> str:
    return _ABSENT if parameter is None else parameter.written
