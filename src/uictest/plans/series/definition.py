"""Read a series file: one series, or one for each combination of the values that it varies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from uictest.plans.scenario import (
    Criteria,
    Files,
    Parts,
    Roots,
    Variant,
    case_id,
    controller_labels,
    expand,
    short_keys,
)
from uictest.plans.scenario.yaml import (
    SCENARIO_SCHEMA,
    SERIES_SCHEMA,
    Document,
    Map,
    Node,
    Override,
    Scalar,
    Sequence as List,
    apply_overrides,
    as_written,
    display_name,
    parse_overrides,
    plain,
    read_file,
    require_schema,
    validated,
    without_axis,
)
from uictest.plans.series.model import DEFAULT_CRITERIA, SeriesFile
from uictest.plans.series.series import Series
from uictest.plans.series.stop_reader import StopReader

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
    written = read_file(path, SERIES_SCHEMA)
    require_schema(written, SERIES_SCHEMA, hints=_NOT_A_SERIES)
    of_command_line = parse_overrides(overrides, seed)
    profiles, documents = _criteria(written, Parts(files))
    file: SeriesFile = validated(SeriesFile, {**plain(written), "criteria": profiles}, written)
    reader = _Reader(path, file, written, files, [*_set_for_all(written)], of_command_line)
    inputs = {each.display: each.sha256 for each in (written.place.document, *documents) if each.sha256}
    return [reader.series(variant, inputs) for variant in reader.variants]


def _set_for_all(tree: Map) -> Iterator[Override]:
    """Yield what the file sets for all of its stops: `repeat`, then the keys under `set`."""
    if (repeat := tree.entries.get("repeat")) is not None:
        yield Override("repeat", repeat.key, (repeat.node,))
    section = tree.get("set")
    for key, entry in section.entries.items() if isinstance(section, Map) else ():
        yield Override(key, entry.key, (entry.node,))


@dataclass(frozen=True)
class _Reader:
    """Reads the series of one file; `common` and then `fixed` change the scenarios of all of its stops."""

    path: Path
    file: SeriesFile
    tree: Map
    files: Files
    common: Sequence[Override]
    of_command_line: Sequence[Override]

    @property
    def fixed(self) -> list[Override]:
        """The values of the command line that all series have."""
        return [each for each in self.of_command_line if len(each.values) == 1]

    @property
    def variants(self) -> list[Variant]:
        """The values by which the series of the file differ; one variant without any."""
        tree = self.tree
        for override in self.fixed:
            tree = without_axis(tree, override.key)
        varied = [each for each in self.of_command_line if len(each.values) > 1]
        return expand(apply_overrides(tree, varied, frozenset()))

    def series(self, variant: Variant, inputs: dict[str, str]) -> Series:
        """Return one series. Raises ScenarioErrors."""
        settings = [setting for each in self.variants for setting in each]
        labels = controller_labels(settings, Parts(self.files))
        own = [Override(each.key, each.value.key, (each.value.node,)) for each in variant]
        short = short_keys(list(dict.fromkeys(setting.key for setting in settings)))
        name = case_id(self.file.name, variant, short, labels)
        reader = StopReader(name, self.file.criteria, self.files, self.common, [*own, *self.fixed])
        stops = reader.stops(self.tree, self.file)
        read = {shown: digest for stop in stops for shown, digest in stop.case.inputs.items()}
        return Series(
            id=name,
            path=Path(display_name(self.path)),
            file=self.file,
            parameters={each.key: as_written(each.value.node) for each in variant},
            stops=stops,
            inputs={**inputs, **read},
        )


def _criteria(tree: Map, parts: Parts) -> tuple[tuple[Criteria, ...], tuple[Document, ...]]:
    """Return the profiles that a series names, and the documents that they come from."""
    entry = tree.entries.get("criteria")
    node: Node = Scalar(DEFAULT_CRITERIA, DEFAULT_CRITERIA, tree.place) if entry is None else entry.node
    nodes = node.items if isinstance(node, List) else (node,)
    resolved = [parts.resolve(each, Criteria, ("criteria",)) for each in nodes]
    documents = tuple(document for each in resolved for document in each.documents)
    return tuple(each.part for each in resolved), documents
