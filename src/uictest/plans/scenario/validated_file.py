"""The result of a validation that a scenario names: found and recognised, never read as a whole here."""

import json
from pathlib import Path
from typing import Any, Final

from uictest.core.document import RESULT, is_of
from uictest.plans.scenario.files import Files, nearest_file
from uictest.plans.scenario.yaml import (
    Map,
    Node,
    Scalar,
    is_file,
    quoted,
    read_document,
    single_error,
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
