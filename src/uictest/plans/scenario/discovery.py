"""Which files are scenarios."""

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from uictest.plans import library
from uictest.plans.scenario.files import Files, trust_hint
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Map,
    Scalar,
    ScenarioErrors,
    collecting,
    diagnose,
    unreadable_error,
    whole_file,
)

SWEEP_SUFFIXES: Final = (".sweep.yaml", ".sweep.yml")
SERIES_SUFFIXES: Final = (".series.yaml", ".series.yml")
_OTHER_KINDS: Final = (*library.FOLDERS.values(), "bench", "channel-map", "validation")
OTHER_SCHEMAS: Final = frozenset(f"uictest/{kind}/1" for kind in _OTHER_KINDS)
"""Schemas of files that may lie among scenarios and are none: parts, benches, channel maps, validations."""


def scenario_trees(
    paths: Sequence[Path], files: Files, diagnostics: list[Diagnostic]
) -> Iterator[tuple[Path, Map]]:
    """Yield the tree of every scenario file at or below ``paths``, once and in order; append errors.

    A folder is searched for ``*.yaml`` and ``*.yml``, except sweeps (``*.sweep.yaml``), series
    (``*.series.yaml``), parts, bench recipes, channel maps, validations, hidden files, and files that
    begin with an underscore (parents only). A file that is named explicitly is always read.
    """
    seen: set[str] = set()
    for path, named in _candidates(paths, diagnostics):
        key = os.path.abspath(path)  # noqa: PTH100 - the same file under two spellings, links left alone
        if key in seen:
            continue
        seen.add(key)
        if not named and not files.roots.contain(path):
            diagnostics.append(link_outside(path))
            continue
        tree = None
        with collecting(diagnostics, whole_file(path)):
            try:
                tree = files.at(path)
            except ScenarioErrors as errors:
                tree = errors.salvaged if isinstance(errors.salvaged, Map) else None
                raise
        if tree is not None and (named or not _is_of_other_kind(tree)):
            yield path, tree


def link_outside(path: Path) -> Diagnostic:
    """The error of a file in a given folder that is a link to a place outside: it is not read."""
    return diagnose(whole_file(path), "a link that leads out of the folders given", hint=trust_hint(path))


def _candidates(paths: Sequence[Path], diagnostics: list[Diagnostic]) -> Iterator[tuple[Path, bool]]:
    for path in paths:
        if not os.path.isdir(path):  # noqa: PTH112 - Path.is_dir raises for names that are too long
            yield path, True
            continue
        for inside in _below(path, diagnostics):
            yield inside, False


def _below(folder: Path, diagnostics: list[Diagnostic]) -> list[Path]:
    def report(error: OSError) -> None:
        diagnostics.extend(unreadable_error(whole_file(Path(error.filename or folder)), error).diagnostics)

    inside: list[Path] = []
    for parent, folders, names in os.walk(folder, onerror=report):
        folders[:] = [name for name in folders if not name.startswith(".")]
        inside.extend(Path(parent, name) for name in names if may_be_scenario(name))
    return sorted(inside, key=Path.as_posix)


def may_be_scenario(name: str) -> bool:
    """Whether a file of this name in a folder is taken for a scenario, unless its schema is another."""
    return (
        name.endswith((".yaml", ".yml"))
        and not name.startswith((".", "_"))
        and not name.endswith((*SWEEP_SUFFIXES, *SERIES_SUFFIXES))
    )


def _is_of_other_kind(tree: Map) -> bool:
    schema = tree.get("schema")
    return isinstance(schema, Scalar) and schema.value in OTHER_SCHEMAS
