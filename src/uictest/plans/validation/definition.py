"""Read a validation file, or the recorded stops of a series."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from uictest.plans import series
from uictest.plans.scenario import Files, Roots, load_file
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Map,
    Node,
    Override,
    Scalar,
    ScenarioErrors,
    Sequence as List,
    describe,
    display_name,
    in_reading_order,
    parse_overrides,
    plain,
    quoted,
    read_file,
    single_error,
    validated,
)
from uictest.plans.validation.model import VALIDATION_SCHEMA, RecordedStops, ValidationFile
from uictest.plans.validation.plan import PlannedComparison, ValidationPlan

_SCHEMA_HINT: Final = f"a validation starts with `schema: {VALIDATION_SCHEMA}`"


def load_validation(
    path: Path, overrides: Sequence[str] = (), trusted: Sequence[Path] = ()
) -> ValidationPlan:
    """Return the validation of a file.

    Args:
        path: of the file.
        overrides: `key=value` texts for the scenarios of all stops.
        trusted: folders that references may lead into, besides that of the file and the working folder.

    Raises:
        ScenarioErrors: with all errors of the file, or of the scenarios that it names.
    """
    files = Files(Roots.of([path], trusted))
    tree = read_file(path, _SCHEMA_HINT)
    _require_schema(tree)
    file: ValidationFile = validated(ValidationFile, plain(tree), tree)
    comparisons = tuple(_comparisons(tree, file, files, parse_overrides(overrides, None)))
    document = tree.place.document
    inputs = {document.display: document.sha256} if document.sha256 else {}
    for each in comparisons:
        inputs |= each.case.inputs
    limits = float(file.speed_tolerance), float(file.confidence)
    return ValidationPlan(file.name, file.title, Path(display_name(path)), comparisons, *limits, inputs)


def plan_of_series(planned: series.Series) -> ValidationPlan:
    """Return the validation by those stops of a series that name recordings."""
    comparisons = [
        PlannedComparison(stop.case, stop.recorded) for stop in planned.stops if stop.recorded is not None
    ]
    limits = float(planned.file.speed_tolerance), float(planned.file.confidence)
    return ValidationPlan(
        planned.id, planned.file.title, planned.path, tuple(comparisons), *limits, planned.inputs
    )


def _comparisons(
    tree: Map, file: ValidationFile, files: Files, overrides: Sequence[Override]
) -> Iterator[PlannedComparison]:
    """Yield the comparisons of all entries. Raises ScenarioErrors with the errors of all."""
    nodes = tree.get("stops")
    assert isinstance(nodes, List)
    diagnostics: list[Diagnostic] = []
    read: list[PlannedComparison] = []
    for stops, node in zip(file.stops, nodes.items, strict=True):
        try:
            read.append(_comparison(file.name, stops, node, files, overrides))
        except ScenarioErrors as errors:
            diagnostics.extend(errors.diagnostics)
    if diagnostics:
        raise ScenarioErrors(in_reading_order(diagnostics))
    yield from _all_different(read, nodes.items)


def _comparison(
    name: str, stops: RecordedStops, node: Node, files: Files, overrides: Sequence[Override]
) -> PlannedComparison:
    reference = series.scenario_of(node)
    files.beside(reference, "scenario")
    path = files.path_of(reference, "scenario")
    cases = load_file(path, [*series.values_set_by(node), *overrides], files)
    if len(cases) != 1:
        message = f"recordings belong to one stop, the scenario has {len(cases)} cases"
        raise single_error(reference.place, message, "scenario", "give each its own entry, with `set`")
    recorded = series.recorded_by(node, files)
    assert recorded is not None
    return PlannedComparison(replace(cases[0], id=f"{name}.{cases[0].id}"), recorded, stops.tuned)


def _all_different(read: Sequence[PlannedComparison], nodes: Sequence[Node]) -> Iterator[PlannedComparison]:
    """Yield the comparisons. Raises ScenarioErrors where a recording is named twice: it would count twice."""
    seen: set[Path] = set()
    for comparison, node in zip(read, nodes, strict=True):
        for file in comparison.recorded.files:
            if file.resolve() in seen:
                message = f"{quoted(file.name)} is named twice"
                raise single_error(node.place, message, "recordings", "each recording is one stop")
            seen.add(file.resolve())
        yield comparison


def _require_schema(tree: Map) -> None:
    schema = tree.get("schema")
    if schema is None:
        raise single_error(tree.place, "missing key 'schema'", "schema", _SCHEMA_HINT)
    if not isinstance(schema, Scalar) or schema.value != VALIDATION_SCHEMA:
        actual = quoted(schema.text) if isinstance(schema, Scalar) else describe(schema)
        raise single_error(
            schema.place, f"expected {VALIDATION_SCHEMA}, found {actual}", "schema", _SCHEMA_HINT
        )
