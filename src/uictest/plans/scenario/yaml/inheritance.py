"""`extends`: one parent per file; maps merge, lists replace, circles are rejected."""

from collections.abc import Callable
from typing import Final

from uictest.plans.scenario.yaml.diagnostics import single_error
from uictest.plans.scenario.yaml.tree import Document, Entry, Map, Scalar, describe, merge
from uictest.plans.scenario.yaml.wording import visible

LONGEST_CHAIN: Final = 16


def _accept(parent: Map, merged: Map) -> None:
    """Accept whatever a child makes of its parent."""


def inherit(
    tree: Map, fetch: Callable[[Scalar], Map], check: Callable[[Map, Map], None] = _accept
) -> tuple[Map, tuple[Document, ...]]:
    """Lay ``tree`` over its parent, its parent's parent and so on.

    ``fetch`` reads the parent that a reference names; ``check`` gets every parent, its own parents merged in,
    and what its child makes of it. Returns the merged tree and the documents it came from,
    the child's first. Raises ScenarioErrors; a circle is reported at the reference that closes it.
    """
    generations = [tree]
    while (entry := generations[-1].entries.get("extends")) is not None:
        reference = _reference(entry)
        parent = fetch(reference)
        _reject_circle(parent, generations, reference)
        generations.append(parent)
    documents = tuple(each.place.document for each in generations)
    merged = generations.pop().without("extends")
    while generations:
        parent, merged = merged, _laid_over(merged, generations.pop())
        check(parent, merged)
    return merged, documents


def _reference(entry: Entry) -> Scalar:
    if not isinstance(entry.node, Scalar) or not isinstance(entry.node.value, str):
        raise single_error(entry.node.place, f"expected one parent, found {describe(entry.node)}", "extends")
    return entry.node


def _laid_over(parent: Map, child: Map) -> Map:
    merged = merge(parent, child.without("extends"))
    assert isinstance(merged, Map)
    return merged


def _reject_circle(parent: Map, generations: list[Map], reference: Scalar) -> None:
    seen = [each.place.document.display for each in generations]
    display = parent.place.document.display
    if display in seen:
        names = " -> ".join([*seen[seen.index(display) :], display])
        raise single_error(reference.place, f"circular 'extends': {visible(names)}", "extends")
    if len(seen) >= LONGEST_CHAIN:
        raise single_error(reference.place, f"more than {LONGEST_CHAIN} generations of 'extends'", "extends")
