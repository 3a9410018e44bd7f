"""A sweep file as read: a scenario, the case that it starts from, which says under `vary` what varies."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Final, NamedTuple

from uictest.plans.scenario import LoadedCase, Override, Parts, Vary, load_with_trees
from uictest.plans.scenario.yaml import (
    SCENARIO_SCHEMA,
    Map,
    Node,
    ScenarioErrors,
    describe,
    diagnose,
    plain,
    require_schema,
    single_error,
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
        cases_sha256: digest of all that the file says of its cases.

    """

    name: str
    title: str
    base: BaseCase
    vary: Vary
    tree: Map
    cases_sha256: str


def read_sweep_file(path: Path, fixed: Sequence[Override], parts: Parts) -> SweepFile:
    """Return a sweep file; `fixed` are values of the command line for its scenario. Raises ScenarioErrors."""
    tree = parts.files.at(path)
    require_schema(tree, SCENARIO_SCHEMA)
    loaded, *_ = load_with_trees(path, fixed, parts, varied=True)
    assert loaded.vary is not None
    sections = loaded.vary.node
    if not isinstance(sections, Map):
        message = f"expected a mapping, found {describe(sections)}"
        raise single_error(sections.place, message, "vary", f"write `{_EXAMPLE}`")
    scenario = loaded.case.scenario
    if (repeat := loaded.tree.entries.get("repeat")) is not None:
        _reject_repeats(loaded, repeat.node)
    _reject_ranges_in_lists(sections)
    # In the order of the file: it is that of the cases.
    content = json.dumps({**plain(tree), "vary": plain(sections)}, default=str)
    return SweepFile(
        name=scenario.name,
        title=scenario.title,
        base=BaseCase(loaded.case, loaded.tree, parts),
        vary=validated(Vary, plain(sections), sections, ("vary",)),
        tree=sections,
        cases_sha256=hashlib.sha256(content.encode()).hexdigest(),
    )


def _reject_repeats(loaded: LoadedCase, node: Node) -> None:
    if (repeat := loaded.case.scenario.repeat) > 1:
        hint = f"a sweep runs one stop per case: {SEEDS_IN_SWEEPS}; --set repeat=1 runs the first stop alone"
        raise single_error(node.place, f"the scenario repeats its stop {repeat} times", "repeat", hint)


def _reject_ranges_in_lists(sections: Map) -> None:
    """Reject a range in the section of lists, and name the section of ranges."""
    lists = sections.get("matrix")
    diagnostics = [
        diagnose(
            entry.node.place,
            f"expected a list of values, found {describe(entry.node)}",
            f"vary.matrix.{key}",
            "a range of numbers goes under `ranges`: {first, last, step} or {first, last, count}",
        )
        for key, entry in (lists.entries.items() if isinstance(lists, Map) else ())
        if isinstance(entry.node, Map)
    ]
    if diagnostics:
        raise ScenarioErrors(diagnostics)
