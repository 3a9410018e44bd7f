"""Read a series file: one series, or one for each combination of the values that it varies."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from uictest.plans.scenario import (
    Criteria,
    Files,
    Override,
    Parts,
    Roots,
    Variant,
    apply_overrides,
    case_id,
    controller_labels,
    expand,
    parse_overrides,
    short_keys,
    without_axis,
)
from uictest.plans.scenario.yaml import (
    SCENARIO_SCHEMA,
    SERIES_SCHEMA,
    Document,
    Map,
    Node,
    Scalar,
    Sequence as List,
    as_written,
    display_name,
    plain,
    read_file,
    require_schema,
    validated,
)
from uictest.plans.series.model import DEFAULT_CRITERIA, Series, SeriesFile
from uictest.plans.series.stops import StopReader, values_set_by

_NOT_A_SERIES: Final = {
    SCENARIO_SCHEMA: "give a scenario a file name that does not end in .series.yaml",
}


def load_series(
    path: Path, overrides: Sequence[str] = (), seed: int | None = None, trusted: Sequence[Path] = ()
) -> list[Series]:
    """Return the series of a file.

    Args:
        path: a ``*.series.yaml``.
        overrides: ``key=value`` texts for the scenarios of all stops. A comma list or
            ``range(first,last,step)`` makes a series of every value.
        seed: of the first stop of every case.
        trusted: folders that references may lead into, besides that of the file and the working folder.

    Raises:
        ScenarioErrors: with all errors of the file, or of the scenarios that it names.

    """
    files = Files(Roots.of([path], trusted))
    tree = read_file(path, SERIES_SCHEMA)
    require_schema(tree, SERIES_SCHEMA, hints=_NOT_A_SERIES)
    of_command_line = parse_overrides(overrides, seed)
    profiles, documents = _criteria(tree, Parts(files))
    file: SeriesFile = validated(SeriesFile, {**plain(tree), "criteria": profiles}, tree)
    inputs = {each.display: each.sha256 for each in (tree.place.document, *documents) if each.sha256}
    common = [*values_set_by(tree, swept=False)]
    fixed = [each for each in of_command_line if len(each.values) == 1]
    variants = _variants(tree, of_command_line)
    settings = [setting for variant in variants for setting in variant]
    labels = controller_labels(settings, Parts(files))
    short = short_keys(list(dict.fromkeys(setting.key for setting in settings)))
    every: list[Series] = []
    for variant in variants:
        name = case_id(file.name, variant, short, labels)
        own = [Override(each.key, each.value.key, (each.value.node,)) for each in variant]
        stops = StopReader(name, file.criteria, files, common, [*own, *fixed]).stops(tree, file)
        read = {shown: digest for stop in stops for shown, digest in stop.case.inputs.items()}
        parameters = {each.key: as_written(each.value.node) for each in variant}
        every.append(Series(name, Path(display_name(path)), file, parameters, stops, {**inputs, **read}))
    return every


def _criteria(tree: Map, parts: Parts) -> tuple[tuple[Criteria, ...], tuple[Document, ...]]:
    """Return the profiles that a series names, and the documents that they come from."""
    entry = tree.entries.get("criteria")
    node: Node = Scalar(DEFAULT_CRITERIA, DEFAULT_CRITERIA, tree.place) if entry is None else entry.node
    nodes = node.items if isinstance(node, List) else (node,)
    resolved = [parts.resolve(each, Criteria, ("criteria",)) for each in nodes]
    documents = tuple(document for each in resolved for document in each.documents)
    return tuple(each.part for each in resolved), documents


def _variants(tree: Map, of_command_line: Sequence[Override]) -> list[Variant]:
    """Return the values by which the series of a file differ; one variant without any."""
    for each in of_command_line:
        if len(each.values) == 1:
            tree = without_axis(tree, each.key)
    varied = [each for each in of_command_line if len(each.values) > 1]
    return expand(apply_overrides(tree, varied))
