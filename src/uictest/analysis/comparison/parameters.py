"""The parameters that differ between two runs of a case."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from uictest.judging import evaluation
from uictest.report import listed


@dataclass(frozen=True, slots=True)
class ParameterOfRun:
    """What one run has for a parameter, or for the name of a part.

    `value` is in `unit`, an SI unit; a setting or a name has none. `written` is the value as its file has it.
    """

    value: float | str
    unit: str
    written: str


@dataclass(frozen=True, slots=True)
class ParameterChange:
    """A parameter, or the name of a part, that differs between two runs, and the cases in which it does.

    `first` and `second` are what the runs have; None where a run does not have it.
    """

    key: str
    first: ParameterOfRun | None
    second: ParameterOfRun | None
    cases: tuple[str, ...]

    @property
    def texts(self) -> tuple[str, str]:
        """What both runs have, for a reader: as written, or `none`."""
        return _text(self.first), _text(self.second)


def change_text(change: ParameterChange) -> str:
    """Return a change for a reader: `controller.slip_threshold: 4 km/h -> 3 km/h`."""
    return f"{change.key}: {' -> '.join(change.texts)}"


def parameter_lines(changes: Iterable[ParameterChange]) -> Iterator[str]:
    """Yield a line for each change, with the cases it is in."""
    for change in changes:
        yield f"parameter {change_text(change)} (in {listed(change.cases)})"


Change = tuple[str, ParameterOfRun | None, ParameterOfRun | None]
"""Key, and what both runs have."""


def parameter_changes(
    pairs: Iterable[tuple[evaluation.CaseResult, evaluation.CaseResult]],
) -> list[ParameterChange]:
    """Return what differs in the parameters of pairs of cases, once for all cases alike."""
    cases: dict[Change, list[str]] = {}
    for first, second in pairs:
        for change in _changes(first, second):
            cases.setdefault(change, []).append(first.id)
    return [ParameterChange(*change, tuple(ids)) for change, ids in cases.items()]


def _changes(first: evaluation.CaseResult, second: evaluation.CaseResult) -> Iterator[Change]:
    told = first.controller_version, second.controller_version
    # A stop that ended in an error tells no version; that is no other version.
    told = told if all(told) else ("", "")
    for role in dict.fromkeys([*first.parts, *second.parts]):
        ours, theirs = first.parts.get(role), second.parts.get(role)
        if ours is None or theirs is None or ours.id != theirs.id or told[0] != told[1]:
            yield from _changes_of_part(role, ours, theirs, told)


def _changes_of_part(
    role: str,
    first: evaluation.EffectivePart | None,
    second: evaluation.EffectivePart | None,
    told: tuple[str, str],
) -> Iterator[Change]:
    names = [None if part is None else ParameterOfRun(part.name, "", part.name) for part in (first, second)]
    if names[0] != names[1]:
        yield role, names[0], names[1]
    if first is None or second is None:
        return
    ours, theirs = _parameters(first, told[0]), _parameters(second, told[1])
    for key in dict.fromkeys([*ours, *theirs]):
        one, other = ours.get(key), theirs.get(key)
        if one is None or other is None or (one.value, one.unit) != (other.value, other.unit):
            yield key, _value(one), _value(other)


def _parameters(part: evaluation.EffectivePart, told: str) -> dict[str, evaluation.Parameter]:
    """Return the parameters of a part by key, with the version that its program said of itself."""
    parameters = {each.key: each for each in part.parameters}
    if (program := evaluation.program_of(part, told)) is not None:
        versions = {"version": program.version, "told_version": program.told_version}
        for key, text in ((f"{part.key}.{name}", text) for name, text in versions.items() if text):
            parameters[key] = evaluation.Parameter(key, text, "", text, "")
    return parameters


def _value(parameter: evaluation.Parameter | None) -> ParameterOfRun | None:
    if parameter is None:
        return None
    return ParameterOfRun(parameter.value, parameter.unit, parameter.written)


def _text(value: ParameterOfRun | None) -> str:
    return "none" if value is None else value.written
