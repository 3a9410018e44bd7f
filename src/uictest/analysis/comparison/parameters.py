"""The parameters that differ between two runs of a case."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

from uictest.judging import evaluation
from uictest.report import NAMED, counted, listed


def short_digest(text: str) -> str:
    """Return the first digits of a SHA-256; another text as it is."""
    return text if len(text) != 64 else f"{text[:12]}..."


@dataclass(frozen=True, slots=True)
class ParameterChange:
    """A parameter, or the name of a part, that differs between two runs, and the cases in which it does.

    `first` and `second` are what the runs have, as their files have it; `none` where a run does not have it.
    """

    key: str
    first: str
    second: str
    cases: tuple[str, ...]

    @property
    def texts(self) -> tuple[str, str]:
        """What both runs have, for a reader: of a digest its first digits."""
        return short_digest(self.first), short_digest(self.second)


def change_text(change: ParameterChange) -> str:
    """Return a change for a reader: `controller.slip_threshold: 4 km/h -> 3 km/h`."""
    return f"{change.key}: {' -> '.join(change.texts)}"


def parameter_lines(changes: Iterable[ParameterChange]) -> Iterator[str]:
    """Yield a line for each change, with the cases it is in."""
    for change in changes:
        cases = listed(change.cases) if len(change.cases) <= NAMED else counted(len(change.cases), "case")
        yield f"parameter {change_text(change)} (in {cases})"


Change = tuple[str, str, str]
"""Key, and what both runs have."""
_NONE: Final = "none"


def parameter_changes(
    pairs: Iterable[tuple[evaluation.CaseResult, evaluation.CaseResult]],
) -> list[ParameterChange]:
    """Return the parameters that differ within pairs of cases, each change once with all its cases."""
    cases: dict[Change, list[str]] = {}
    for first, second in pairs:
        for change in _changes_of_case(first, second):
            cases.setdefault(change, []).append(first.id)
    return [ParameterChange(*change, tuple(ids)) for change, ids in cases.items()]


def _changes_of_case(first: evaluation.CaseResult, second: evaluation.CaseResult) -> Iterator[Change]:
    told_versions = first.controller_version, second.controller_version
    # A stop that ended in an error tells no version, which is not another version.
    told_versions = told_versions if all(told_versions) else ("", "")
    for role in dict.fromkeys([*first.parts, *second.parts]):
        ours, theirs = first.parts.get(role), second.parts.get(role)
        if ours is None or theirs is None or ours.id != theirs.id or told_versions[0] != told_versions[1]:
            yield from _changes_of_part(role, ours, theirs, told_versions)


def _changes_of_part(
    role: str,
    first: evaluation.EffectivePart | None,
    second: evaluation.EffectivePart | None,
    told_versions: tuple[str, str],
) -> Iterator[Change]:
    names = [_NONE if part is None else part.name for part in (first, second)]
    if names[0] != names[1]:
        yield role, names[0], names[1]
    if first is None or second is None:
        return
    ours, theirs = _parameters_by_key(first, told_versions[0]), _parameters_by_key(second, told_versions[1])
    for key in dict.fromkeys([*ours, *theirs]):
        before, after = ours.get(key), theirs.get(key)
        if before is None or after is None or (before.value, before.unit) != (after.value, after.unit):
            yield key, before.written if before else _NONE, after.written if after else _NONE


def _parameters_by_key(part: evaluation.EffectivePart, told: str) -> dict[str, evaluation.Parameter]:
    """Return the parameters of a part by key, with the version that its program said of itself."""
    parameters = {each.key: each for each in part.parameters}
    if (program := evaluation.program_of(part, told)) is not None:
        versions = {"version": program.version, "told_version": program.told_version}
        for key, text in ((f"{part.key}.{name}", text) for name, text in versions.items() if text):
            parameters[key] = evaluation.Parameter(key, text, "", text, "")
    return parameters
