"""Two sides under common noise: every group that both have, as data in JSON."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from uictest.analysis.comparison.paired.difference import (
    FEWEST_PAIRS,
    PairedDifference,
    PairedGroup,
    paired_group,
)
from uictest.analysis.comparison.paired.groups import Group, GroupKey, Side, groups_of
from uictest.core import envelope
from uictest.judging.evaluation import json_form
from uictest.report import RunContent


@dataclass(frozen=True, slots=True)
class NotPaired:
    """A group whose stops do not pair, and why."""

    name: str
    reason: str


@dataclass(frozen=True, slots=True)
class PairedComparison:
    """All paired differences of the second side from the first."""

    first: str
    second: str
    groups: tuple[PairedGroup, ...]
    not_paired: tuple[NotPaired, ...] = ()


def compare_paired_runs(first: RunContent, second: RunContent) -> PairedComparison:
    """Return the paired differences of two runs."""
    return compare_sides(_side(first), _side(second))


def _side(run: RunContent) -> Side:
    return Side(run.name, run.results, run.series)


def compare_sides(first: Side, second: Side, varied: Collection[str] = ()) -> PairedComparison:
    """Return the differences of the groups that both sides have, under the noise that both met.

    `varied` are the keys in which the sides differ. A group with one stop on each side is left out: it has no
    interval.
    """
    ours, theirs = (groups_of(side, varied) for side in (first, second))
    groups: list[PairedGroup] = []
    not_paired = [*_only(first.name, ours, theirs), *_only(second.name, theirs, ours)]
    for key, group in ours.items():
        stops = group.stops, theirs[key].stops if key in theirs else {}
        if key not in theirs or max(map(len, stops)) < FEWEST_PAIRS:
            continue
        try:
            groups.append(paired_group(group.name, *stops))
        except ValueError as error:
            not_paired.append(NotPaired(group.name, str(error)))
    return PairedComparison(first.name, second.name, tuple(groups), tuple(not_paired))


def _only(
    side: str, groups: Mapping[GroupKey, Group], others: Mapping[GroupKey, Group]
) -> Iterator[NotPaired]:
    """Yield the groups that this side alone has."""
    for key, group in groups.items():
        if key not in others and len(group.stops) >= FEWEST_PAIRS:
            yield NotPaired(group.name, f"only {side} has it")


def paired_form(compared: PairedComparison) -> dict[str, Any]:
    """Return the JSON form; what has no number is null."""
    form: dict[str, Any] = json_form(
        {
            "first": compared.first,
            "second": compared.second,
            "groups": [_group_form(group) for group in compared.groups],
            "not_paired": [dataclasses.asdict(each) for each in compared.not_paired],
        }
    )
    return form


def variants_json(run: str, compared: Sequence[PairedComparison]) -> str:
    """Return the variants of a run as a JSON document."""
    form = {
        **envelope.head(envelope.RESULT, "variants"),
        "run": run,
        "variants": [paired_form(each) for each in compared],
    }
    return json.dumps(form, indent=2, allow_nan=False)


def _group_form(group: PairedGroup) -> dict[str, Any]:
    differences = [_difference_form(each) for each in group.differences]
    return {**dataclasses.asdict(group), "differences": differences}


def _difference_form(difference: PairedDifference) -> dict[str, Any]:
    own = dataclasses.asdict(difference)
    return {**own, "pairs": difference.pairs}
