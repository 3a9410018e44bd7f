"""A sweep file as read: the case that it starts from, and what it varies.

A sweep is a scenario that says under `vary` what varies. Version 0.2 wrote it as a file of its own, which
named a scenario and had the sections of `vary` beside that name, `matrix` under the name of `grid`.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Final, Literal, NamedTuple

from pydantic import Field

from uictest.plans.scenario import (
    SWEEP_SUFFIXES,
    DescribedFile,
    LoadedCase,
    Override,
    Parts,
    Vary,
    load_with_trees,
)
from uictest.plans.scenario.yaml import (
    SCENARIO_SCHEMA,
    SWEEP_SCHEMA,
    Map,
    Node,
    Scalar,
    ScenarioErrors,
    describe,
    diagnose,
    plain,
    quoted,
    require_schema,
    single_error,
    suggestion,
    validated,
)
from uictest.plans.sweeps.base_case import SEEDS_IN_SWEEPS, BaseCase

_EXAMPLE: Final = "vary: {matrix: {rail.friction: [0.08, 0.10]}}"


class SweepFile(NamedTuple):
    """A sweep file as read.

    Args:
        name: of the sweep.
        title: one line for people.
        base: the case that is varied.
        vary: what varies, validated.
        tree: the sections of `vary` as written.
        names: what the file calls a section, where that is not `vary.` and its name.
        cases_sha256: digest of all that the file says of its cases.
        written_now: how a file of 0.2 is written now, empty for others.

    """

    name: str
    title: str
    base: BaseCase
    vary: Vary
    tree: Map
    cases_sha256: str
    names: dict[str, str] | None = None
    written_now: str = ""

    def key(self, section: str) -> str:
        """Return what messages call a section."""
        return f"vary.{section}" if self.names is None else self.names.get(section, section)


def read_sweep_file(path: Path, fixed: Sequence[Override], parts: Parts) -> SweepFile:
    """Return a sweep file; `fixed` are values of the command line for its scenario. Raises ScenarioErrors."""
    tree = parts.files.at(path)
    if require_schema(tree, SCENARIO_SCHEMA, SWEEP_SCHEMA) == SWEEP_SCHEMA:
        return _of_0_2(tree, fixed, parts)
    loaded, *_ = load_with_trees(path, fixed, parts, varied=True)
    assert loaded.vary is not None
    sections = loaded.vary.node
    if not isinstance(sections, Map):
        message = f"expected a mapping, found {describe(sections)}"
        raise single_error(sections.place, message, "vary", f"write `{_EXAMPLE}`")
    scenario = loaded.case.scenario
    if (repeat := loaded.tree.entries.get("repeat")) is not None:
        _reject_repeats(loaded, repeat.node, "repeat", "the scenario")
    _reject_ranges_in_lists(sections, "matrix", "vary.matrix")
    return SweepFile(
        name=scenario.name,
        title=scenario.title,
        base=BaseCase(loaded.case, loaded.tree, parts),
        vary=validated(Vary, plain(sections), sections, ("vary",)),
        tree=sections,
        cases_sha256=_sha256({**plain(tree), "vary": plain(sections)}),
    )


class _SweepFileOf02(Vary, DescribedFile):
    """The keys of a sweep file of 0.2."""

    schema_id: Literal["uictest/sweep/1"] = Field(alias="schema")
    scenario: str
    case: str | None = None
    matrix: dict[str, Annotated[tuple[Any, ...], Field(min_length=1)]] | None = Field(
        default=None, alias="grid"
    )


def _of_0_2(tree: Map, fixed: Sequence[Override], parts: Parts) -> SweepFile:
    _reject_ranges_in_lists(tree, "grid", "grid")
    file: _SweepFileOf02 = validated(_SweepFileOf02, plain(tree), tree)
    reference, case_id = tree.entries["scenario"], tree.get("case")
    assert isinstance(reference.node, Scalar)
    if reference.node.text.endswith(SWEEP_SUFFIXES):
        message = f"{quoted(reference.node.text)} is a sweep, not a scenario"
        raise single_error(reference.node.place, message, "scenario")
    parts.files.beside(reference.node, "scenario")
    path = reference.node.place.document.folder / reference.node.text
    cases = load_with_trees(path, fixed, parts)
    if any(each.case.train is not None for each in cases):
        message = f"{quoted(reference.node.text)} is a train, which no file of 0.2 sweeps"
        hint = f"write `schema: {SCENARIO_SCHEMA}`, `extends: {reference.node.text}` and `vary`"
        raise single_error(reference.node.place, message, "scenario", hint)
    loaded = _chosen(cases, case_id, reference.node)
    _reject_repeats(loaded, reference.node, "scenario", quoted(reference.node.text))
    lists = tree.entries.get("grid")
    return SweepFile(
        name=file.name,
        title=file.title,
        base=BaseCase(loaded.case, loaded.tree, parts),
        vary=file,
        tree=tree if lists is None else tree.with_entry("matrix", lists),
        cases_sha256=_sha256(plain(tree)),
        names={"matrix": "grid"},
        written_now=_written_now(reference.node.text, file.case),
    )


def _written_now(scenario: str, case: str | None) -> str:
    values = f", the values of {case}" if case else ""
    return (
        f"written as in 0.2; now a sweep is a scenario: `schema: {SCENARIO_SCHEMA}`, `extends: {scenario}`"
        f"{values}, and under `vary` matrix (was grid), ranges, zip and sample"
    )


def _chosen(cases: Sequence[LoadedCase], case_id: object, reference: Scalar) -> LoadedCase:
    """Return the case that the file names, or the only one."""
    by_id = {each.case.id: each for each in cases}
    ids = list(by_id)
    if not isinstance(case_id, Scalar) or case_id.value is None:
        if len(cases) == 1:
            return cases[0]
        hint = f"add one of them as `case`: {', '.join(ids[:8])}{', ...' if len(ids) > 8 else ''}"
        message = f"{quoted(reference.text)} has {len(ids)} cases, a sweep starts from one"
        raise single_error(reference.place, message, "scenario", hint)
    if case_id.text not in by_id:
        message = f"no case {quoted(case_id.text)} there"
        raise single_error(case_id.place, message, "case", suggestion(case_id.text, ids))
    return by_id[case_id.text]


def _reject_repeats(loaded: LoadedCase, node: Node, key: str, scenario: str) -> None:
    if (repeat := loaded.case.scenario.repeat) > 1:
        hint = f"a sweep runs one stop per case: {SEEDS_IN_SWEEPS}; --set repeat=1 runs the first stop alone"
        raise single_error(node.place, f"{scenario} repeats its stop {repeat} times", key, hint)


def _reject_ranges_in_lists(tree: Map, section: str, shown: str) -> None:
    """Reject a range in the section of lists, and name the section of ranges."""
    lists = tree.get(section)
    diagnostics = [
        diagnose(
            entry.node.place,
            f"expected a list of values, found {describe(entry.node)}",
            f"{shown}.{key}",
            "a range of numbers goes under `ranges`: {first, last, step} or {first, last, count}",
        )
        for key, entry in (lists.entries.items() if isinstance(lists, Map) else ())
        if isinstance(entry.node, Map)
    ]
    if diagnostics:
        raise ScenarioErrors(diagnostics)


def _sha256(content: dict[str, Any]) -> str:
    # In the order of the file: it is that of the cases.
    return hashlib.sha256(json.dumps(content, default=str).encode()).hexdigest()
