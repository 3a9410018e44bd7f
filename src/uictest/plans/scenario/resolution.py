"""From the tree of one case to its scenario: references replaced by parts, everything validated."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from uictest.core.document import RESULT, is_of
from uictest.plans.scenario.files import Files, nearest_file
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.part_keys import PART_KEYS, part_nodes
from uictest.plans.scenario.references import Parts, ResolvedPart
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Document,
    Key,
    Map,
    Node,
    Scalar,
    ScenarioErrors,
    Sequence as List,
    dotted,
    is_file,
    plain,
    quoted,
    read_document,
    single_error,
    validated,
)

VALIDATED: Final = "validated"
"""The key of a scenario."""
LARGEST: Final = 64 * 1024 * 1024
"""Largest file that is read, bytes: it holds every figure of every recorded stop."""
_HINT: Final = "name the validation.json that `uictest validate` wrote"


def validated_file(node: Node, files: Files) -> str | None:
    """Return the path of the validation that a scenario names; None where this is no text.

    Raises ScenarioErrors for a file that is missing, lies outside the roots, or holds something else.
    """
    if not isinstance(node, Scalar) or not isinstance(node.value, str):
        return None
    path = files.path_of(node, VALIDATED)
    if not is_file(path):
        raise single_error(
            node.place, f"no such file: {quoted(node.text)}", VALIDATED, nearest_file(path, _HINT)
        )
    if not files.once(f"{VALIDATED}:{path}", lambda: _is_validation(path)):
        raise single_error(
            node.place, f"{quoted(node.text)} is not the result of a validation", VALIDATED, _HINT
        )
    return str(path)


def with_validated_file(data: dict[str, Any], tree: Map, files: Files) -> None:
    """Put the path of the validation, if a scenario names one, in the place of what it wrote."""
    node = tree.get(VALIDATED)
    path = None if node is None else validated_file(node, files)
    if path is not None:
        data[VALIDATED] = path


def _is_validation(path: Path) -> bool:
    try:
        form = json.loads(read_document(path, LARGEST, _HINT).text)
    except (ValueError, RecursionError):
        return False
    return is_of(form, RESULT, "validation") and bool(form.get("domains"))


def resolve(tree: Map, parts: Parts) -> tuple[Scenario, tuple[Document, ...]]:
    """The scenario and the documents its parts came from.

    Raises ScenarioErrors; errors in parts and errors in the scenario do not hide each other.
    """
    data: dict[str, Any] = plain(tree)
    diagnostics: list[Diagnostic] = []
    failed: set[str] = set()
    documents: list[Document] = []
    for key, node in part_nodes(tree):
        try:
            _put(data, key, _part(parts, key, node, documents))
        except ScenarioErrors as errors:
            diagnostics.extend(errors.diagnostics)
            failed.add(dotted(key))
            _remove(data, key)
    try:
        with_validated_file(data, tree, parts.files)
    except ScenarioErrors as errors:
        diagnostics.extend(errors.diagnostics)
    try:
        scenario = validated(Scenario, data, tree)
    except ScenarioErrors as errors:
        diagnostics.extend(each for each in errors.diagnostics if each.key not in failed)
    if diagnostics:
        raise ScenarioErrors(diagnostics)
    return scenario, tuple(documents)


def _part(parts: Parts, key: Key, node: Node, documents: list[Document]) -> Any:
    """The part, or the tuple of parts, that stands at ``key``."""
    reference = PART_KEYS[key]
    nodes = node.items if reference.several and isinstance(node, List) else (node,)
    if not nodes:
        raise single_error(node.place, "an empty list", dotted(key), "name at least one")
    listed = nodes[0] is not node
    resolved = _resolved_parts(parts, reference.model, key, nodes, listed=listed)
    documents.extend(document for each in resolved for document in each.documents)
    return tuple(each.part for each in resolved) if reference.several else resolved[0].part


def _resolved_parts(
    parts: Parts, model: Any, key: Key, nodes: Sequence[Node], *, listed: bool
) -> list[ResolvedPart]:
    """Resolve every reference, or raise the errors of all of them."""
    resolved: list[ResolvedPart] = []
    diagnostics: list[Diagnostic] = []
    for number, node in enumerate(nodes):
        try:
            resolved.append(parts.resolve(node, model, (*key, number) if listed else key))
        except ScenarioErrors as errors:
            diagnostics.extend(errors.diagnostics)
    if diagnostics:
        raise ScenarioErrors(diagnostics)
    return resolved


def _put(data: dict[str, Any], key: Key, part: Any) -> None:
    _mapping_of(data, key)[str(key[-1])] = part


def _remove(data: dict[str, Any], key: Key) -> None:
    del _mapping_of(data, key)[str(key[-1])]


def _mapping_of(data: dict[str, Any], key: Key) -> dict[str, Any]:
    for element in key[:-1]:
        data = data[str(element)]
    return data
