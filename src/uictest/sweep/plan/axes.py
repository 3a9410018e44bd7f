"""The values of a sweep's parameters, checked one by one against the scenario's models."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from operator import attrgetter
from typing import Annotated, Any, Final, get_args

from uictest.scenario import CONDITION, Setting, value_label
from uictest.scenario.yaml import (
    Diagnostic,
    Document,
    Entry,
    Map,
    Model,
    Node,
    Physical,
    Scalar,
    ScenarioErrors,
    Sequence as List,
    as_written,
    diagnose,
    entry_at,
    plain,
    quoted,
    resolve as plain_scalar,
    single_error,
    validated,
    visible,
)
from uictest.sweep.plan.amount import Amount, common_unit, evenly, stepwise, written
from uictest.sweep.plan.base import Base
from uictest.sweep.plan.model import Distribution, Range, Sample
from uictest.sweep.plan.plan import Draw, Listed, Sampled, Value
from uictest.sweep.plan.variation import refusals, value_at, varied

_OPTIONS: Final = ("--set", "--seed")
"""What the texts of options are called where files have their names."""
_Column = tuple[str, Entry, Sequence[Node]]
"""A key, where its values stand, and the values."""
_Row = tuple[Value, ...]
_LABEL: Final[Callable[[Value], str]] = attrgetter("label")
_TEXT: Final[Callable[[Value], str]] = attrgetter("text")


class Axes:
    """Reads groups of parameters for one base, gathering errors instead of stopping at one."""

    def __init__(self, base: Base) -> None:
        self._base = base
        self.found: list[Diagnostic] = []
        self.documents: list[Document] = []

    def listed(self, entries: Mapping[str, Entry]) -> Listed | None:
        """Return the group in which the given lists go together; None, and errors told, where they cannot."""
        columns = [(key, entry, _items(entry.node)) for key, entry in entries.items()]
        if not self._equally_long(columns):
            return None
        rows = self._rows(columns)
        self._refuse_repeated(rows, columns[0], _LABEL, "case ids would be the same")
        return Listed(tuple(entries), tuple(rows)) if len(rows) == len(columns[0][2]) else None

    def sampled(self, sample: Sample, tree: Map) -> Sampled | None:
        """Return the group that a sample draws; `tree` is its section of the file."""
        draws: list[Draw] = []
        for key, distribution in sample.parameters.items():
            entry, _ = entry_at(tree, ("parameters", key))
            try:
                draws.append(self._draw(key, entry, distribution))
            except ScenarioErrors as errors:
                self.found.extend(errors.diagnostics)
        if len(draws) != len(sample.parameters):
            return None
        keys = tuple(sample.parameters)
        return Sampled(keys, tuple(draws), sample.method, sample.cases, sample.size, sample.seed)

    def refuse_conditions_alone(self, entries: Mapping[str, Entry]) -> None:
        """Tell rail conditions beside which the friction of the scenario would stay."""
        for key, entry in entries.items():
            if key.startswith(CONDITION):
                choice = entry.node.get("choice") if isinstance(entry.node, Map) else None
                for node in _items(choice or entry.node):
                    self.found.extend(self._base.changed_alone({key: Entry(entry.key, node)}))

    def _equally_long(self, columns: Sequence[_Column]) -> bool:
        first, _, items = columns[0]
        unequal = [column for column in columns if len(column[2]) != len(items)]
        for key, entry, others in unequal:
            message = f"{len(others)} values where {quoted(first)} has {len(items)}"
            hint = "lists under zip must be equally long; grid combines lists of any length"
            self.found.append(diagnose(entry.key, message, f"zip.{key}", hint))
        return not unequal

    def _rows(self, columns: Sequence[_Column]) -> list[_Row]:
        """Return the rows that the scenario accepts, and tell the first that it does not, for all of them."""
        rows: list[_Row] = []
        told: tuple[Diagnostic, ...] = ()
        more = 0
        for number, nodes in enumerate(zip(*(items for _, _, items in columns), strict=True), start=1):
            row = {key: Entry(entry.key, node) for (key, entry, _), node in zip(columns, nodes, strict=True)}
            try:
                rows.append(self._row(row, number, explained=not told))
            except ScenarioErrors as errors:
                if errors.diagnostics == told:
                    break  # what is said of one value as of another is wrong with the key
                more += bool(told)
                told = told or errors.diagnostics
        self._tell(told, more, len(columns[0][2]))
        return rows

    def _tell(self, diagnostics: Sequence[Diagnostic], more: int, total: int) -> None:
        verb = "is" if more == 1 else "are"
        counted = f"; {more} more of the {total} values {verb} refused" if more else ""
        self.found.extend(replace(each, message=each.message + counted) for each in diagnostics[:1])
        self.found.extend(diagnostics[1:])

    def _row(self, row: Mapping[str, Entry], number: int, *, explained: bool = True) -> tuple[Value, ...]:
        """Return the values of a row. Raises ScenarioErrors, empty ones where they need not be explained."""
        contents = self._plain_quantities(row, explained) or self._resolved(row)
        return tuple(
            Value(as_written(entry.node), contents[key], value_label(Setting(key, entry, number)))
            for key, entry in row.items()
        )

    def _resolved(self, row: Mapping[str, Entry]) -> dict[str, Any]:
        try:
            scenario, documents = self._base.scenario_with(row)
        except ScenarioErrors as errors:
            raise self._told_at_values(errors, row) from None
        self.documents.extend(documents)
        return {key: value_at(scenario, key) for key in row}

    def _told_at_values(self, errors: ScenarioErrors, row: Mapping[str, Entry]) -> ScenarioErrors:
        """Return errors in which one, at the new values, stands for those in files that the base has."""
        key, entry = next(iter(row.items()))
        sound = {*self._base.case.inputs, *_OPTIONS} - {entry.node.place.document.display}
        files = frozenset(map(visible, sound))
        others = [each for each in errors.diagnostics if each.file not in files]
        caused = next((each for each in errors.diagnostics if each.file in files), None)
        if caused is None:
            return errors
        values = " with ".join(quoted(as_written(each.node)) for each in row.values())
        message = f"{values} does not suit {caused.key or 'the scenario'}: {caused.message}"
        return ScenarioErrors([*others, diagnose(entry.node.place, message, key, caused.hint)])

    def _plain_quantities(self, row: Mapping[str, Entry], explained: bool) -> dict[str, Any] | None:
        """Return the values of quantities without reading the scenario again; None where that is needed."""
        scenario = self._base.case.scenario
        contents: dict[str, Any] = {}
        for key, entry in row.items():
            field = quantity_field(scenario, key)
            if field is None or not isinstance(entry.node, Scalar) or entry.node.value is None:
                return None
            contents[key] = validated(field, plain(entry.node), entry.node, tuple(key.split(".")))
        if next(refusals(varied(scenario, contents), row), None) is None:
            return contents
        if explained:
            return None  # the scenario itself says best what is wrong
        raise ScenarioErrors(())

    def _refuse_repeated(
        self, rows: Sequence[_Row], column: _Column, told_apart_by: Callable[[Value], str], hint: str
    ) -> None:
        key, entry, _ = column
        repeated = list(_repeated(rows, told_apart_by))
        if repeated:
            message = f"{quoted(', '.join(value.text for value in repeated[0]))} is there twice"
            self._tell([diagnose(entry.key, message, key, hint)], len(repeated) - 1, len(rows))

    def _draw(self, key: str, entry: Entry, distribution: Distribution) -> Draw:
        """Check the ends of a distribution: a field accepts an interval, so what lies between is as good."""
        if distribution.choice is not None:
            listed, _ = entry_at(entry.node, ("choice",))
            return Draw(distribution, choices=self._choices(key, Entry(entry.key, listed.node)))
        for text, place in _ends(distribution, entry.node):
            self._row({key: Entry(entry.key, _scalar(text, place))}, 1)
        kind = self._kind(key, entry)
        unit = common_unit(list(_amounts(distribution)))
        assert unit is not None
        return Draw(distribution, unit, kind)

    def _choices(self, key: str, entry: Entry) -> tuple[Value, ...]:
        column = key, entry, _items(entry.node)
        rows = self._rows([column])
        self._refuse_repeated(rows, column, _TEXT, "each value of a choice is as likely as the others")
        if len(rows) < len(column[2]):
            raise ScenarioErrors(())  # why is told already
        return tuple(value for (value,) in rows)

    def _kind(self, key: str, entry: Entry) -> str:
        field = quantity_field(self._base.case.scenario, key)
        physical = None if field is None else _physical(field)
        if physical is None or physical.kind.name == "count":
            raise single_error(
                entry.key,
                "only a quantity can be drawn from a distribution",
                key,
                "take `choice` and list values",
            )
        return physical.kind.name


def range_node(given: Range, place_of: Node) -> List:
    """Return the list of values that a range stands for, in the place of the range."""
    first, last, unit = given.first.number, given.last.number, given.first.unit
    numbers = evenly(first, last, given.count) if given.count else stepwise(first, last, _step(given))
    texts = [written(number, unit) for number in numbers]
    return List(tuple(_scalar(text, place_of) for text in texts), place_of.place)


def _scalar(text: str, place_of: Node) -> Scalar:
    return Scalar(plain_scalar(text), text, place_of.place)


def _step(given: Range) -> Any:
    assert given.step is not None
    return given.step.number


def quantity_field(scenario: Any, key: str) -> Any:
    """Return the annotation of the field at a dotted key where it may hold a quantity, else None.

    Raises nothing: a key that leads nowhere has no field.
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
    return None if _physical(annotation) is None else annotation


def _physical(annotation: Any) -> Physical | None:
    if isinstance(annotation, Physical):
        return annotation
    if isinstance(annotation, type) and issubclass(annotation, Model):
        return None  # the quantities inside a mapping are not the field itself
    for inner in (*getattr(annotation, "__metadata__", ()), *get_args(annotation)):
        found = _physical(inner)
        if found is not None:
            return found
    return None


def _repeated(rows: Iterable[_Row], told_apart_by: Callable[[Value], str]) -> Iterator[_Row]:
    seen: set[tuple[str, ...]] = set()
    for row in rows:
        names = tuple(map(told_apart_by, row))
        if names in seen:
            yield row
        seen.add(names)


def _items(node: Node) -> Sequence[Node]:
    return node.items if isinstance(node, List) else (node,)


def _amounts(distribution: Distribution) -> Iterator[Amount]:
    amounts = distribution.uniform or distribution.log_uniform or distribution.triangular
    if amounts is not None:
        yield from amounts
    elif distribution.normal is not None:
        yield from (distribution.normal.lower, distribution.normal.upper)


def ends_of(distribution: Distribution) -> tuple[Amount, Amount]:
    """Return the smallest and the largest value of a distribution that is no choice."""
    first, *_, last = _amounts(distribution)
    return first, last


def _ends(distribution: Distribution, node: Node) -> Iterator[tuple[str, Node]]:
    """Yield the smallest and the largest value with the place that they stand at."""
    amounts = list(_amounts(distribution))
    name = "log-uniform" if distribution.log_uniform else distribution.form
    for amount, place in ((amounts[0], 0), (amounts[-1], len(amounts) - 1)):
        key = ("lower", "upper")[min(place, 1)] if distribution.normal else place
        yield str(amount), entry_at(node, (name, key))[0].node
