"""Read the groups of a sweep's parameters, and check each value against the scenario's models."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from operator import attrgetter
from typing import Annotated, Any, Final, get_args

from uictest.plans.scenario import Distribution, Range, Sample, Setting, controller_labels, value_label
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Document,
    Entry,
    List,
    Map,
    Model,
    Node,
    QuantityField,
    Scalar,
    ScenarioErrors,
    as_written,
    common_unit,
    diagnose,
    entry_at,
    evenly_spaced,
    plain,
    quantity_text,
    quoted,
    scalar_value,
    single_error,
    spaced_by_step,
    validated,
    visible,
)
from uictest.plans.sweeps.base_case import BaseCase, inconsistencies, is_free, items_of, value_at, with_values
from uictest.plans.sweeps.column import ParameterValue
from uictest.plans.sweeps.plan import ListedGroup, ParameterDraw, SampledGroup

OF_RANGES: Final = "vary.ranges"
"""The section whose entries are ranges; those of all others are lists."""
_OPTIONS: Final = ("--set", "--seed")
"""Names of documents that are options, where files have their paths."""
_Column = tuple[str, Entry, Sequence[Node]]
"""A key, the place of its values, and the values."""
_Row = tuple[ParameterValue, ...]
_LABEL: Final[Callable[[ParameterValue], str]] = attrgetter("label")
_TEXT: Final[Callable[[ParameterValue], str]] = attrgetter("text")


class GroupReader:
    """Reads groups of parameters for one base case, and collects errors instead of stopping at the first."""

    def __init__(self, base: BaseCase, ranges: Mapping[str, Range]) -> None:
        self._base = base
        self._ranges = ranges
        self.diagnostics: list[Diagnostic] = []
        self.documents: list[Document] = []
        self._labels: dict[int, str] = {}

    def count(self, entries: Mapping[str, Entry], section: str) -> int:
        """Return the number of values of each key of a section, without making those of a range."""
        key, entry = next(iter(entries.items()))
        return self._ranges[key].size if section == OF_RANGES else len(items_of(entry.node))

    def listed(self, entries: Mapping[str, Entry], section: str) -> ListedGroup | None:
        """Return the group in which the given lists of a section change together; None if they cannot."""
        of_range = self._ranges if section == OF_RANGES else {}
        columns = [
            (key, entry, items_of(range_node(of_range[key], entry.node) if key in of_range else entry.node))
            for key, entry in entries.items()
        ]
        if not self._equally_long(columns, section):
            return None
        rows = self._rows(columns)
        self._reject_repeated(rows, columns[0], _LABEL, "case ids would be the same")
        return ListedGroup(tuple(entries), tuple(rows)) if len(rows) == len(columns[0][2]) else None

    def sampled(self, sample: Sample, tree: Map) -> SampledGroup | None:
        """Return the group that a sample draws; `tree` is its section of the file."""
        draws: list[ParameterDraw] = []
        for key, distribution in sample.parameters.items():
            entry, _ = entry_at(tree, ("parameters", key))
            try:
                draws.append(self._draw(key, entry, distribution))
            except ScenarioErrors as errors:
                self.diagnostics.extend(errors.diagnostics)
        if len(draws) != len(sample.parameters):
            return None
        keys = tuple(sample.parameters)
        return SampledGroup(keys, tuple(draws), sample.method, sample.cases, sample.size, sample.seed)

    def _equally_long(self, columns: Sequence[_Column], section: str) -> bool:
        first, _, items = columns[0]
        unequal = [column for column in columns if len(column[2]) != len(items)]
        for key, entry, others in unequal:
            message = f"{len(others)} values where {quoted(first)} has {len(items)}"
            hint = f"lists under {section} must be equally long; others are combined, of any length"
            self.diagnostics.append(diagnose(entry.key, message, f"{section}.{key}", hint))
        return not unequal

    def _rows(self, columns: Sequence[_Column]) -> list[_Row]:
        settings = [
            Setting(key, Entry(entry.key, node), 1) for key, entry, nodes in columns for node in nodes
        ]
        self._labels |= controller_labels(settings, self._base.parts)
        rows: list[_Row] = []
        first: tuple[Diagnostic, ...] = ()
        more = 0
        for number, nodes in enumerate(zip(*(items for _, _, items in columns), strict=True), start=1):
            row = {key: Entry(entry.key, node) for (key, entry, _), node in zip(columns, nodes, strict=True)}
            try:
                rows.append(self._row(row, number, explained=not first))
            except ScenarioErrors as errors:
                if errors.diagnostics == first:
                    break  # the same error for two values is one of the key
                more += bool(first)
                first = first or errors.diagnostics
        self._report(first, more, len(columns[0][2]))
        return rows

    def _report(self, diagnostics: Sequence[Diagnostic], more: int, total: int) -> None:
        verb = "is" if more == 1 else "are"
        others = f"; {more} more of the {total} values {verb} rejected" if more else ""
        self.diagnostics.extend(each._replace(message=each.message + others) for each in diagnostics[:1])
        self.diagnostics.extend(diagnostics[1:])

    def _row(self, row: Mapping[str, Entry], number: int, *, explained: bool = True) -> _Row:
        contents = self._plain_quantities(row, explained) or self._resolved(row)
        return tuple(
            ParameterValue(as_written(entry.node), contents[key], value_label(setting, self._labels))
            for key, entry in row.items()
            for setting in (Setting(key, entry, number),)
        )

    def _resolved(self, row: Mapping[str, Entry]) -> dict[str, Any]:
        try:
            contents, documents = self._base.contents(row)
        except ScenarioErrors as errors:
            raise self._at_new_values(errors, row) from None
        self.documents.extend(documents)
        return contents

    def _at_new_values(self, errors: ScenarioErrors, row: Mapping[str, Entry]) -> ScenarioErrors:
        """Return errors in which one, at the new values, replaces those in the files of the base case."""
        key, entry = next(iter(row.items()))
        valid = {*self._base.case.inputs, *_OPTIONS} - {entry.node.location.document.display}
        files = frozenset(map(visible, valid))
        others = [each for each in errors.diagnostics if each.file not in files]
        cause = next((each for each in errors.diagnostics if each.file in files), None)
        if cause is None:
            return errors
        values = " with ".join(quoted(as_written(each.node)) for each in row.values())
        message = f"{values} is inconsistent with {cause.key or 'the scenario'}: {cause.message}"
        return ScenarioErrors([*others, diagnose(entry.node.location, message, key, cause.hint)])

    def _plain_quantities(self, row: Mapping[str, Entry], explained: bool) -> dict[str, Any] | None:
        """Return the values of quantities without reading the scenario again, None where it must be read."""
        scenario = self._base.case.scenario
        if self._base.case.train is not None:
            return None
        contents: dict[str, Any] = {}
        for key, entry in row.items():
            field = quantity_field(scenario, key)
            if field is None or not isinstance(entry.node, Scalar) or entry.node.value is None:
                return None
            contents[key] = validated(field, plain(entry.node), entry.node, tuple(key.split(".")))
        if next(inconsistencies(with_values(scenario, contents), row), None) is None:
            return contents
        if explained:
            return None  # reading the scenario gives the best message
        raise ScenarioErrors(())

    def _reject_repeated(
        self, rows: Sequence[_Row], column: _Column, name_of: Callable[[ParameterValue], str], hint: str
    ) -> None:
        key, entry, _ = column
        repeated = list(_repeated_names(rows, name_of))
        if repeated:
            message = f"{quoted(', '.join(value.text for value in repeated[0]))} is there twice"
            self._report([diagnose(entry.key, message, key, hint)], len(repeated) - 1, len(rows))

    def _draw(self, key: str, entry: Entry, distribution: Distribution) -> ParameterDraw:
        """Check the bounds of a distribution: a field accepts an interval, so all between is valid."""
        if distribution.choice is not None:
            listed, _ = entry_at(entry.node, ("choice",))
            return ParameterDraw(distribution, choices=self._choices(key, Entry(entry.key, listed.node)))
        for text, node in _bounds_of_distribution(distribution, entry.node):
            self._row({key: Entry(entry.key, _scalar(text, node))}, 1)
        unit = common_unit(distribution.quantities)
        assert unit is not None
        kind = self._kind_of_unit(key, entry, unit)
        return ParameterDraw(distribution, unit, kind)

    def _choices(self, key: str, entry: Entry) -> tuple[ParameterValue, ...]:
        column = key, entry, items_of(entry.node)
        rows = self._rows([column])
        self._reject_repeated(rows, column, _TEXT, "each value of a choice is as likely as the others")
        if len(rows) < len(column[2]):
            raise ScenarioErrors(())  # reported already
        return tuple(value for (value,) in rows)

    def _kind_of_unit(self, key: str, entry: Entry, unit: str) -> str:
        location = self._base.place_of(key)
        if is_free(*location) and not unit:
            return ""
        field = quantity_field(*location)
        physical = None if field is None else _quantity_field(field)
        if physical is None or physical.kind.name == "count":
            raise single_error(
                entry.key,
                "only a quantity can be drawn from a distribution",
                key,
                "take `choice` and list values",
            )
        return physical.kind.name


def range_node(values: Range, place_of: Node) -> List:
    """Return the list of values in a range, in the place of the range."""
    first, last, unit = values.first.number, values.last.number, values.first.unit
    if values.step is not None:
        numbers = spaced_by_step(first, last, values.step.number)
    else:
        assert values.count is not None  # checked by the model
        numbers = evenly_spaced(first, last, values.count)
    texts = [quantity_text(number, unit) for number in numbers]
    return List(tuple(_scalar(text, place_of) for text in texts), place_of.location)


def _scalar(text: str, place_of: Node) -> Scalar:
    return Scalar(scalar_value(text), text, place_of.location)


def quantity_field(scenario: Any, key: str) -> Any:
    """Return the annotation of the field at a dotted key if it can hold a quantity, else None.

    An unknown key has no field.
    """
    *above, last = key.split(".")
    try:
        model = value_at(scenario, ".".join(above)) if above else scenario
    except KeyError:
        return None
    field = type(model).model_fields.get(last) if isinstance(model, Model) else None
    if field is None:
        return None
    annotation = Annotated[(field.annotation, *field.metadata)] if field.metadata else field.annotation
    return None if _quantity_field(annotation) is None else annotation


def _quantity_field(annotation: Any) -> QuantityField | None:
    if isinstance(annotation, QuantityField):
        return annotation
    if isinstance(annotation, type) and issubclass(annotation, Model):
        return None  # the quantities inside a mapping are not the field itself
    for inner in (*getattr(annotation, "__metadata__", ()), *get_args(annotation)):
        physical = _quantity_field(inner)
        if physical is not None:
            return physical
    return None


def _repeated_names(rows: Iterable[_Row], name_of: Callable[[ParameterValue], str]) -> Iterator[_Row]:
    seen: set[tuple[str, ...]] = set()
    for row in rows:
        names = tuple(map(name_of, row))
        if names in seen:
            yield row
        seen.add(names)


def _bounds_of_distribution(distribution: Distribution, node: Node) -> Iterator[tuple[str, Node]]:
    quantities = distribution.quantities
    name = "log-uniform" if distribution.log_uniform else distribution.form
    for quantity, index in ((quantities[0], 0), (quantities[-1], len(quantities) - 1)):
        key = ("lower", "upper")[min(index, 1)] if distribution.normal else index
        yield str(quantity), entry_at(node, (name, key))[0].node
