"""The scenario that a sweep varies, as a tree: where a new value is written, and what it then means."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from uictest.scenario import (
    EXPANSION_KEYS,
    PART_KEYS,
    SWEEP_SUFFIXES,
    Case,
    Files,
    Parts,
    Roots,
    Scenario,
    Variant,
    changed_alone,
    distinct,
    expand,
    load,
    resolve,
    with_default_parts,
)
from uictest.scenario.yaml import (
    Diagnostic,
    Document,
    Entry,
    Map,
    Override,
    Scalar,
    apply_overrides,
    dotted,
    inherit,
    quoted,
    single_error,
    suggestion,
    with_value,
)
from uictest.sweep.plan.variation import outside_in

DOTTED_PART_KEYS: Final = frozenset(map(dotted, PART_KEYS))


@dataclass(frozen=True)
class Base:
    """A case and the tree that it came from."""

    case: Case
    tree: Map
    parts: Parts

    def scenario_with(self, settings: Mapping[str, Entry]) -> tuple[Scenario, tuple[Document, ...]]:
        """Return the scenario in which the dotted keys have other values, and the documents read for it.

        Raises ScenarioErrors as if the scenario's file had said so.
        """
        return resolve(self._tree_with(settings), self.parts)

    def changed_alone(self, settings: Mapping[str, Entry]) -> Iterator[Diagnostic]:
        """Yield a change of the rail condition that leaves the friction. Raises ScenarioErrors."""
        return changed_alone(self.tree, self._tree_with(settings))

    def _tree_with(self, settings: Mapping[str, Entry]) -> Map:
        tree = self.tree
        for key in outside_in(settings):
            tree = with_value(tree, key, settings[key], DOTTED_PART_KEYS)
        return tree


def read_base(reference: Scalar, wanted: Scalar | None, overrides: Sequence[Override], roots: Roots) -> Base:
    """Return the case that the file named by `reference` holds, or the `wanted` one of several.

    `overrides` have one value each; `roots` are where references may lead. Raises ScenarioErrors.
    """
    files = Files(roots)
    if reference.text.endswith(SWEEP_SUFFIXES):
        raise single_error(
            reference.place, f"{quoted(reference.text)} is a sweep, not a scenario", "scenario"
        )
    own = files.beside(reference, "scenario")
    texts = [each.place.document.text for each in overrides if each.place.document.display == "--set"]
    seed = next((each.values[0] for each in overrides if each.place.document.display == "--seed"), None)
    given = int(seed.text) if isinstance(seed, Scalar) else None
    cases = load([reference.place.document.folder / reference.text], texts, given, roots.folders)
    place = _wanted(cases, wanted, reference)
    merged, _ = inherit(own, lambda parent: files.beside(parent, "extends"))
    merged = merged.with_entry("name", own.entries["name"])
    tree = apply_overrides(with_default_parts(merged), overrides, DOTTED_PART_KEYS)
    variants = distinct(expand(tree)) if overrides else expand(tree)
    return Base(cases[place], _fixed(tree.without(*EXPANSION_KEYS), variants[place]), Parts(files))


def _fixed(tree: Map, variant: Variant) -> Map:
    for setting in sorted(variant, key=lambda setting: setting.key.count(".")):
        tree = with_value(tree, setting.key, setting.value, DOTTED_PART_KEYS)
    return tree


def _wanted(cases: Sequence[Case], wanted: Scalar | None, reference: Scalar) -> int:
    ids = [case.id for case in cases]
    if wanted is None and len(ids) == 1:
        return 0
    if wanted is None:
        hint = f"add one of them as `case`: {', '.join(ids[:8])}{', ...' if len(ids) > 8 else ''}"
        message = f"{quoted(reference.text)} has {len(ids)} cases, a sweep starts from one"
        raise single_error(reference.place, message, "scenario", hint)
    if wanted.text not in ids:
        raise single_error(
            wanted.place, f"no case {quoted(wanted.text)} there", "case", suggestion(wanted.text, ids)
        )
    return ids.index(wanted.text)
