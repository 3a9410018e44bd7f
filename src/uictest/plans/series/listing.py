"""Read lists of stops from the scenarios and the recordings that they name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import prod
from pathlib import Path
from typing import Final, NamedTuple

from uictest.plans.scenario import Case, Files, Override, is_path, load_file
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Entry,
    Map,
    Node,
    Scalar,
    ScenarioErrors,
    Sequence as List,
    diagnose,
    entry_at,
    in_reading_order,
    is_file,
    quoted,
    single_error,
)
from uictest.plans.series.model import Recorded, Role, SeriesFile, Stops


def values_set_by(node: Node, *, swept: bool = True) -> Iterator[Override]:
    """Yield what a file or one of its entries sets: `repeat`, then the keys under `set`.

    With `swept`, every key is an axis, so that the ids of its stops name the values. Raises ScenarioErrors
    for an empty list.
    """
    if not isinstance(node, Map):
        return
    if (repeat := node.entries.get("repeat")) is not None:
        yield Override("repeat", repeat.key, (repeat.node,))
    section = node.get("set")
    for key, entry in section.entries.items() if isinstance(section, Map) else ():
        values = entry.node.items if swept and isinstance(entry.node, List) else (entry.node,)
        if not values:
            raise single_error(entry.node.place, "an empty list makes no stop", f"set.{key}")
        yield Override(key, entry.key, tuple(values), swept=swept)


class Stop(NamedTuple):
    """What one entry of a list of stops names: a scenario, its cases, and recordings of them."""

    reference: Scalar
    cases: list[Case]
    recorded: Recorded | None


def read_entry(
    node: Node, key: str, files: Files, common: Sequence[Override] = (), last: Sequence[Override] = ()
) -> Stop:
    """Return what an entry names, which may be the reference of a scenario alone. Raises ScenarioErrors.

    `common` and `last` are set before and after what the entry sets; errors of the scenario are at `key`.
    """
    reference = node.get("scenario") if isinstance(node, Map) else node
    assert isinstance(reference, Scalar)
    path = files.scenario_beside(reference, key)
    overrides = [*common, *values_set_by(node), *last]
    if "train" not in files.at(path).entries:  # criteria in place of its own lack what the scenario names
        overrides.append(Override("expect", reference.place, (Scalar("pass", "pass", reference.place),)))
    cases = load_file(path, overrides, files)
    listed = node.get("recordings") if isinstance(node, Map) else None
    if not isinstance(listed, List) or not listed.items:
        return Stop(reference, cases, None)
    if any(case.train is not None for case in cases):
        message = f"{quoted(reference.text)} is a train; recordings are of one car"
        raise single_error(reference.place, message, key, "name a scenario with `vehicle`")
    recorded = Recorded(tuple(_existing(each, files) for each in listed.items), _channel_map(node, files))
    if len(cases) > 1:
        message = f"recordings belong to one stop, the scenario has {len(cases)} cases"
        raise single_error(reference.place, message, key, "give each its own entry, with `set`")
    return Stop(reference, cases, recorded)


def _existing(reference: Node, files: Files) -> Path:
    assert isinstance(reference, Scalar)
    path = files.path_of(reference, "recordings")
    if not is_file(path):
        raise single_error(reference.place, f"no such file: {quoted(reference.text)}", "recordings")
    return path


def _channel_map(node: Node, files: Files) -> str:
    reference = node.get("map") if isinstance(node, Map) else None
    if not isinstance(reference, Scalar):
        return Stops.model_fields["map"].get_default()  # type: ignore[no-any-return]
    return str(files.path_of(reference, "map")) if is_path(reference.text) else reference.text


def recorded_twice(read: Iterable[tuple[Recorded | None, Node]]) -> Iterator[Diagnostic]:
    """Yield every recording that is named before: one stop would count as two."""
    seen: set[Path] = set()
    for recorded, node in read:
        for file in recorded.files if recorded else ():
            if file.resolve() in seen:
                message = f"{quoted(file.name)} is named twice"
                yield diagnose(node.place, message, "recordings", "each recording is one stop")
            seen.add(file.resolve())


MOST_STOPS: Final = 100_000
"""Stops that the values under `set` make of all series of a file, at most; chosen."""


def require_few(tree: Map, series: int) -> None:
    """Raise ScenarioErrors where so many series have too many stops, counted before any scenario is read."""
    lists = (tree.entries[role].node for role in ("dry", "wet"))
    entries = (each for node in lists for each in (node.items if isinstance(node, List) else (node,)))
    stops = sum(prod(len(each.values) for each in values_set_by(entry)) for entry in entries)
    if (count := series * stops) > MOST_STOPS:
        message = f"{count} stops ({series} series of {stops}); a file makes at most {MOST_STOPS}"
        raise single_error(tree.entries["wet"].key, message, "wet", "list fewer values, or run several files")


class ListedStops(NamedTuple):
    """What an entry of a list of stops names, and the list that it is in."""

    role: Role
    entry: Entry
    read: Stop

    def cases_of(self, car: int) -> list[Case]:
        """Return the cases of the car with this number, from 1; a car alone is meant by any."""
        return [case for case in self.read.cases if case.train is None or case.train.number == car]


def read_stops(
    tree: Map, file: SeriesFile, files: Files, common: Sequence[Override], last: Sequence[Override]
) -> list[ListedStops]:
    """Return what a series lists, dry stops first. Raises ScenarioErrors with the errors of all entries.

    `common` and `last` are set before and after what an entry sets.
    """
    diagnostics: list[Diagnostic] = []
    listed: list[ListedStops] = []
    roles: tuple[tuple[Role, tuple[Stops, ...]], ...] = (("dry", file.dry), ("wet", file.wet))
    for role, entries in roles:
        for number in range(len(entries)):
            entry, _ = entry_at(tree, (role, number))
            try:
                listed.append(ListedStops(role, entry, read_entry(entry.node, role, files, common, last)))
            except ScenarioErrors as errors:
                diagnostics.extend(errors.diagnostics)
    if not diagnostics:
        diagnostics.extend(_of_other_length(listed))
    if not diagnostics:
        diagnostics.extend(_only_of_trains(tree, file, cars_of(listed)))
    if diagnostics:
        raise ScenarioErrors(in_reading_order(list(dict.fromkeys(diagnostics))))
    return listed


def cars_of(listed: Sequence[ListedStops]) -> int:
    """Return how many cars the trains of a series have; 0 where its stops are those of a car alone."""
    place = listed[0].read.cases[0].train
    return 0 if place is None else len(place.scenarios)


def _of_other_length(listed: Sequence[ListedStops]) -> Iterator[Diagnostic]:
    """Yield stops of another number of cars than the first: there would be cars without their reference."""
    first = listed[0].read.cases[0]
    for each in listed:
        for case in each.read.cases:
            if _kind(case) != _kind(first):
                message = f"{quoted(case.id)} is {_kind(case)}, {quoted(first.id)} {_kind(first)}"
                hint = "all stops of a series are of the same train"
                yield diagnose(each.entry.node.place, message, each.role, hint)
                break


def _kind(case: Case) -> str:
    return "a car alone" if case.train is None else f"of a train of {len(case.train.scenarios)}"


def _only_of_trains(tree: Map, file: SeriesFile, cars: int) -> Iterator[Diagnostic]:
    """Yield `cars: all` where there is no train."""
    if file.cars == "all" and not cars:
        hint = "leave it out, or name scenarios with `train`"
        yield diagnose(tree.entries["cars"].node.place, "the stops are of cars alone", "cars", hint)
