"""The stops of a series: read from the scenarios and recordings that its lists name, and checked together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from math import prod
from operator import attrgetter
from pathlib import Path
from typing import Final, NamedTuple

from uictest.core.series_measures import Rail
from uictest.plans import scenario as scenarios
from uictest.plans.scenario import (
    LONGEST,
    PASS,
    Case,
    Criteria,
    Expectation,
    Files,
    Override,
    is_path,
    load_file,
)
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Entry,
    List,
    Map,
    Node,
    Scalar,
    diagnose,
    entry_at,
    is_file,
    quoted,
    read_each,
    require_none,
    single_error,
)
from uictest.plans.series.model import PlannedStop, Recorded, Role, SeriesFile, Stops


def values_set_by(node: Node, *, swept: bool = True) -> Iterator[Override]:
    """Yield the values that a file or one of its entries sets: `repeat`, then the keys under `set`.

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
            raise single_error(entry.node.location, "an empty list makes no stop", f"set.{key}")
        yield Override(key, entry.key, tuple(values), swept=swept)


class Stop(NamedTuple):
    """Contents of one entry of a list of stops: a scenario, its cases, and recordings of them."""

    reference: Scalar
    cases: list[Case]
    recorded: Recorded | None


def read_entry(
    node: Node, key: str, files: Files, common: Sequence[Override] = (), last: Sequence[Override] = ()
) -> Stop:
    """Return the contents of an entry, which may be just the reference of a scenario. Raises ScenarioErrors.

    `common` and `last` are set before and after what the entry sets; errors of the scenario are at `key`.
    """
    reference = node.get("scenario") if isinstance(node, Map) else node
    assert isinstance(reference, Scalar)
    path = files.scenario_beside(reference, key)
    overrides = [*common, *values_set_by(node), *last]
    if "train" not in files.at(path).entries:  # criteria in place of its own lack what the scenario names
        overrides.append(
            Override("expect", reference.location, (Scalar("pass", "pass", reference.location),))
        )
    cases = load_file(path, overrides, files)
    listed = node.get("recordings") if isinstance(node, Map) else None
    if not isinstance(listed, List) or not listed.items:
        return Stop(reference, cases, None)
    if any(case.train is not None for case in cases):
        message = f"{quoted(reference.text)} is a train; recordings are of one car"
        raise single_error(reference.location, message, key, "name a scenario with `vehicle`")
    recorded = Recorded(
        tuple(_existing_file(each, files) for each in listed.items), _channel_map(node, files)
    )
    if len(cases) > 1:
        message = f"recordings belong to one stop, the scenario has {len(cases)} cases"
        raise single_error(reference.location, message, key, "give each its own entry, with `set`")
    return Stop(reference, cases, recorded)


def _existing_file(reference: Node, files: Files) -> Path:
    assert isinstance(reference, Scalar)
    path = files.path_of(reference, "recordings")
    if not is_file(path):
        raise single_error(reference.location, f"no such file: {quoted(reference.text)}", "recordings")
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
                yield diagnose(node.location, message, "recordings", "each recording is one stop")
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
    """Contents of an entry of a list of stops, and the list that it is in."""

    role: Role
    entry: Entry
    read: Stop


def read_stops(
    tree: Map, file: SeriesFile, files: Files, common: Sequence[Override], last: Sequence[Override]
) -> list[ListedStops]:
    """Return the stops of a series, dry stops first. Raises ScenarioErrors with the errors of all entries.

    `common` and `last` are set before and after what an entry sets.
    """

    def read(location: tuple[Role, int]) -> ListedStops:
        entry, _ = entry_at(tree, location)
        return ListedStops(location[0], entry, read_entry(entry.node, location[0], files, common, last))

    roles: tuple[tuple[Role, tuple[Stops, ...]], ...] = (("dry", file.dry), ("wet", file.wet))
    listed = read_each(read, ((role, index) for role, entries in roles for index in range(len(entries))))
    require_none(_of_other_length(listed))
    if file.cars == "all" and not cars_of(listed):
        hint = "leave it out, or name scenarios with `train`"
        raise single_error(tree.entries["cars"].node.location, "the stops are of cars alone", "cars", hint)
    return listed


def cars_of(listed: Sequence[ListedStops]) -> int:
    """Return the number of cars in the trains of a series; 0 where its stops are those of a car alone."""
    train = listed[0].read.cases[0].train
    return 0 if train is None else len(train.scenarios)


def _of_other_length(listed: Sequence[ListedStops]) -> Iterator[Diagnostic]:
    """Yield stops of another number of cars than the first: there would be cars without their reference."""
    first = listed[0].read.cases[0]
    for each in listed:
        for case in each.read.cases:
            if _train_size(case) != _train_size(first):
                message = f"{quoted(case.id)} is {_train_size(case)}, {quoted(first.id)} {_train_size(first)}"
                hint = "all stops of a series are of the same train"
                yield diagnose(each.entry.node.location, message, each.role, hint)
                break


def _train_size(case: Case) -> str:
    return "a car alone" if case.train is None else f"of a train of {len(case.train.scenarios)}"


def _differences_of_trains(dry: Case, wet: Case) -> Iterator[str]:
    for number, (one, other) in enumerate(zip(dry.cars, wet.cars, strict=True), start=1):
        of_car = "" if wet.train is None else f" of car {number}"
        for key in _OF_TRAIN:
            if attrgetter(key)(one.scenario) != attrgetter(key)(other.scenario):
                yield f"{quoted(key)}{of_car}"


_OF_TRAIN: Final = (
    *("vehicle", "brake.command", "brake.position", "brake.transmission", "coupler", "brake.system"),
    *("brake.pad", "brake.disc_temperature", "brake.initial_disc_temperature", "faults", "rail.gradient"),
)
"""Keys of a scenario at which a wet stop has what the dry one has."""
_DECISIVE: Final = (
    *("vehicle", "coupler", "initial_speed", "brake", "rail", "rig", "controller", "sanders", "faults"),
    "simulation",
)
"""Keys of a scenario that decide, with the seed, how the stop goes."""


class StopReader(NamedTuple):
    """Makes the stops of one series.

    Args:
        series: the id of the series, which the ids of its cases begin with.
        of_all_cars: the same without the number of the car, which the ids of its trains begin with.
        criteria: of the series; those that judge single stops are added to the scenarios.
        car: that is judged where the stops are of trains, from 1.

    """

    series: str
    of_all_cars: str
    criteria: tuple[Criteria, ...]
    car: int

    def stops(self, listed: Sequence[ListedStops]) -> tuple[PlannedStop, ...]:
        """Return the stops, dry ones first. Raises ScenarioErrors with the errors of all entries."""
        of_entries = read_each(lambda each: list(self._of_entry(each)), listed)
        read = [
            (stop, entry) for stops, (_, entry, _) in zip(of_entries, listed, strict=True) for stop in stops
        ]
        recordings = recorded_twice((stop.recorded, entry.node) for stop, entry in read)
        require_none((*_unsuitable_stops(read), *_drawn_twice(read), *recordings, *_unmatched_stops(read)))
        return (*(stop for stop, _ in read), *self._without_wsp([stop for stop, _ in read]))

    def _without_wsp(self, stops: Sequence[PlannedStop]) -> Iterator[PlannedStop]:
        """Yield the wet stops by which K_wet is judged, with the WSP bypassed: what the tested one is for."""
        of_k_wet = [
            criterion
            for profile in self.criteria
            for criterion in profile.criteria
            if criterion.scope == "series" and criterion.measure == "k_wet"
        ]
        for stop in stops:
            scenario = stop.case.scenario
            judged = any(scenarios.applies_to(criterion, scenario) for criterion in of_k_wet)
            if stop.role == "wet" and scenario.rig.wsp == "active" and judged:
                # Wheels lock: a stop that fails is nothing to record or to draw before others.
                case = stop.case.changed(scenarios.with_wsp_bypassed)
                changed = case.scenario.model_copy(update={"expect": Expectation("fail")})
                name = f"{self.series}.bypassed.{stop.case.id.removeprefix(f'{self.series}.')}"
                case = replace(case, id=name[:LONGEST], scenario=changed)
                if case.train is not None:
                    own = case.train.train.removeprefix(f"{self.of_all_cars}.")
                    train = replace(case.train, train=f"{self.of_all_cars}.bypassed.{own}")
                    case = replace(case, train=train)
                yield PlannedStop("bypassed", case, rail=stop.rail)

    def _of_entry(self, listed: ListedStops) -> Iterator[PlannedStop]:
        role, _, read = listed
        for case in read.cases:
            if case.train is not None and case.train.number != self.car:
                continue  # a car alone is meant by any number
            rail: Rail = "uncleaned" if case.scenario.rail.cleaning_in_force is None else "cleaned"
            own = self._case_with_profiles(case, read.reference)
            yield PlannedStop(role, own, read.recorded, "" if role == "dry" else rail)

    def _case_with_profiles(self, case: Case, reference: Scalar) -> Case:
        own = {profile.name: profile for profile in case.scenario.criteria}
        for profile in self.criteria:
            if own.get(profile.name, profile) != profile:
                message = f"the series and the scenario have different profiles named {quoted(profile.name)}"
                raise single_error(reference.location, message, "criteria", "give one of them another name")
        further = [profile for profile in self.criteria if profile.name not in own]
        judged = {criterion.id for profile in case.scenario.criteria for criterion in profile.criteria}
        for profile in further:
            if twice := next((each.id for each in profile.criteria if each.id in judged), ""):
                message = f"criterion {quoted(twice)} is in the profiles of the series and of the scenario"
                raise single_error(reference.location, message, "criteria", "give one of them another id")
        # The id of the series says which car is judged.
        name = f"{self.series}.{case.id if case.train is None else case.train.train}"
        if len(name) > LONGEST:
            message = f"the id {quoted(name)} is longer than {LONGEST} characters"
            raise single_error(reference.location, message, "name")
        # What is expected of the scenario alone, by its own criteria, says nothing about a stop of a series.
        judged_by = {"criteria": (*case.scenario.criteria, *further), "expect": PASS}
        own_train = f"{self.of_all_cars}.{case.train.train}" if case.train is not None else ""
        return replace(
            case,
            id=name,
            scenario=case.scenario.model_copy(update=judged_by),
            # Neighbours with the same train run at once: those of the series of other cars, too.
            train=None if case.train is None else replace(case.train, train=own_train),
        )


def _unsuitable_stops(read: Sequence[tuple[PlannedStop, Entry]]) -> Iterator[Diagnostic]:
    seen: set[str] = set()
    for stop, entry in read:
        location, scenario, shown = entry.node.location, stop.case.scenario, quoted(stop.case.id)
        if stop.case.id in seen:
            yield diagnose(
                location, f"a second stop {shown}", stop.role, "tell them apart by values under `set`"
            )
        seen.add(stop.case.id)
        for key in ("until", "drag"):
            if getattr(scenario, key) is not None:
                message = f"{shown} has `{key}`: a series is judged by stops to standstill"
                yield diagnose(location, message, stop.role, f"leave `{key}` out")
        condition = scenario.rail.condition.name
        if stop.role == "dry" and condition != "dry":
            message = f"the rail of {shown} is {quoted(condition)}"
            yield diagnose(location, message, "dry", "the reference is a stop on dry rail")


def _drawn_twice(read: Sequence[tuple[PlannedStop, Entry]]) -> Iterator[Diagnostic]:
    """Yield every stop that an earlier one runs as well: one draw would count as two."""
    drawn: dict[tuple[str, str], dict[int, PlannedStop]] = {}
    for stop, entry in read:
        decisive = [getattr(car.scenario, key) for car in stop.case.cars for key in _DECISIVE]
        earlier = drawn.setdefault((stop.role, repr(decisive)), {})
        shared = next((seed for seed in _seeds_of_stop(stop) if seed in earlier), None)
        if shared is not None:
            message = f"{quoted(stop.case.id)} is {quoted(earlier[shared].case.id)} again with seed {shared}"
            advice = "take other seeds, or a larger `repeat` of one of them"
            yield diagnose(entry.node.location, message, stop.role, advice)
        earlier |= {seed: stop for seed in _seeds_of_stop(stop) if seed not in earlier}


def _seeds_of_stop(stop: PlannedStop) -> range:
    scenario = stop.case.scenario
    return range(scenario.seed, scenario.seed + (0 if stop.recorded else scenario.repeat))


def _unmatched_stops(read: Sequence[tuple[PlannedStop, Entry]]) -> Iterator[Diagnostic]:
    """Yield stops from a speed without its counterpart, and wet stops of another train than the dry ones."""
    first: dict[str, dict[float, Case]] = {"dry": {}, "wet": {}}
    for stop, _ in read:
        first[stop.role].setdefault(stop.speed, stop.case)
    for stop, entry in read:
        other = "wet" if stop.role == "dry" else "dry"
        counterpart = first[other].get(stop.speed)
        shown = stop.case.scenario.initial_speed.text
        if counterpart is None:
            speeds = ", ".join(each.scenario.initial_speed.text for each in first[other].values())
            message, hint = f"no {other} stop from {shown}", f"there are such from {speeds}"
            yield diagnose(entry.node.location, message, stop.role, hint)
        elif stop.role == "wet":
            for key in _differences_of_trains(counterpart, stop.case):
                message = f"{quoted(stop.case.id)} and the dry stop from {shown} differ in {key}"
                yield diagnose(entry.node.location, message, "wet", "the reference is of the same train")
