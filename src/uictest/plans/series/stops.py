"""Read lists of stops from the scenarios and the recordings that they name; and the stops of a series."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final, NamedTuple

from uictest.core.series_measures import Rail
from uictest.plans import scenario as scenarios
from uictest.plans.scenario import LONGEST, Case, Criteria, Files, Override, Scenario, is_path, load_file
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
from uictest.plans.series.model import PlannedStop, Recorded, Role, SeriesFile, Stops


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
    cases = load_file(path, [*common, *values_set_by(node), *last], files)
    if any(case.train is not None for case in cases):
        message = f"{quoted(reference.text)} is a train; a series runs cars alone"
        raise single_error(reference.place, message, key)
    listed = node.get("recordings") if isinstance(node, Map) else None
    if not isinstance(listed, List) or not listed.items:
        return Stop(reference, cases, None)
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


def _differences_of_train(dry: Scenario, wet: Scenario) -> Iterator[str]:
    """Yield the keys of what must be the same in both stops and is not."""
    dry_discs, wet_discs = dry.brake.initial_disc_temperature, wet.brake.initial_disc_temperature
    for key, one, other in (
        ("vehicle", dry.vehicle, wet.vehicle),
        ("brake.command", dry.brake.command, wet.brake.command),
        ("brake.position", dry.brake.position, wet.brake.position),
        ("brake.system", dry.brake.system, wet.brake.system),
        ("brake.pad", dry.brake.pad, wet.brake.pad),
        ("brake.disc_temperature", dry.brake.disc_temperature, wet.brake.disc_temperature),
        ("brake.initial_disc_temperature", dry_discs, wet_discs),
        ("faults", dry.faults, wet.faults),
        ("rail.gradient", dry.rail.gradient, wet.rail.gradient),
    ):
        if one != other:
            yield key


_DECISIVE: Final = ("vehicle", "initial_speed", "brake", "rail", "rig", "controller", "faults", "simulation")
"""Keys of a scenario that decide, with the seed, how the stop goes."""


class StopReader(NamedTuple):
    """Reads the stops of one series.

    Args:
        series: the id of the series, which the ids of its cases begin with.
        criteria: of the series; those that judge single stops are added to the scenarios.
        files: that the series may read.
        common: what the file sets for all stops; an entry may set it otherwise.
        last: what holds for all stops, whatever their entry says.

    """

    series: str
    criteria: tuple[Criteria, ...]
    files: Files
    common: Sequence[Override]
    last: Sequence[Override]

    def stops(self, tree: Map, file: SeriesFile) -> tuple[PlannedStop, ...]:
        """Return the stops, dry ones first. Raises ScenarioErrors with the errors of all entries."""
        diagnostics: list[Diagnostic] = []
        read: list[tuple[PlannedStop, Entry]] = []
        roles: tuple[tuple[Role, tuple[Stops, ...]], ...] = (("dry", file.dry), ("wet", file.wet))
        for role, entries in roles:
            for number in range(len(entries)):
                entry, _ = entry_at(tree, (role, number))
                try:
                    read += [(stop, entry) for stop in self._of_entry(role, entry)]
                except ScenarioErrors as errors:
                    diagnostics.extend(errors.diagnostics)
        if not diagnostics:
            diagnostics.extend(_repeated(read))
            diagnostics.extend(_not_to_standstill(read))
            diagnostics.extend(_drawn_twice(read))
            diagnostics.extend(recorded_twice((stop.recorded, entry.node) for stop, entry in read))
            diagnostics.extend(_not_dry(read))
            diagnostics.extend(_unmatched(read))
        if diagnostics:
            raise ScenarioErrors(in_reading_order(list(dict.fromkeys(diagnostics))))
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
                rig = scenario.rig.model_copy(update={"wsp": "bypassed"})
                # Wheels lock: a stop that fails is nothing to record or to draw before others.
                changed = scenario.model_copy(update={"rig": rig, "expect": "fail"})
                name = f"{self.series}.bypassed.{stop.case.id.removeprefix(f'{self.series}.')}"
                case = replace(stop.case, id=name[:LONGEST], scenario=changed)
                yield PlannedStop("bypassed", case, rail=stop.rail)

    def _of_entry(self, role: Role, entry: Entry) -> Iterator[PlannedStop]:
        read = read_entry(entry.node, role, self.files, self.common, self.last)
        for case in read.cases:
            rail: Rail = "uncleaned" if case.scenario.rail.cleaning_in_force is None else "cleaned"
            own = self._case(case, read.reference)
            yield PlannedStop(role, own, read.recorded, "" if role == "dry" else rail)

    def _case(self, case: Case, reference: Scalar) -> Case:
        """Return a case of a scenario as a stop of this series."""
        own = {profile.name: profile for profile in case.scenario.criteria}
        for profile in self.criteria:
            if own.get(profile.name, profile) != profile:
                message = f"the series and the scenario have different profiles named {quoted(profile.name)}"
                raise single_error(reference.place, message, "criteria", "give one of them another name")
        further = [profile for profile in self.criteria if profile.name not in own]
        judged = {criterion.id for profile in case.scenario.criteria for criterion in profile.criteria}
        for profile in further:
            if twice := next((each.id for each in profile.criteria if each.id in judged), ""):
                message = f"criterion {quoted(twice)} is in the profiles of the series and of the scenario"
                raise single_error(reference.place, message, "criteria", "give one of them another id")
        name = f"{self.series}.{case.id}"
        if len(name) > LONGEST:
            message = f"the id {quoted(name)} is longer than {LONGEST} characters"
            raise single_error(reference.place, message, "name")
        # What is expected of the scenario alone, by its own criteria, says nothing about a stop of a series.
        judged_by = {"criteria": (*case.scenario.criteria, *further), "expect": "pass"}
        return replace(case, id=name, scenario=case.scenario.model_copy(update=judged_by))


def _repeated(read: Sequence[tuple[PlannedStop, Entry]]) -> Iterator[Diagnostic]:
    """Yield every case with the id of an earlier one."""
    seen: set[str] = set()
    for stop, entry in read:
        if stop.case.id in seen:
            message = f"a second stop {quoted(stop.case.id)}"
            yield diagnose(entry.node.place, message, stop.role, "tell them apart by values under `set`")
        seen.add(stop.case.id)


def _not_to_standstill(read: Sequence[tuple[PlannedStop, Entry]]) -> Iterator[Diagnostic]:
    """Yield every stop that its brake alone does not bring to a standstill."""
    for stop, entry in read:
        for key in ("until", "drag"):
            if getattr(stop.case.scenario, key) is not None:
                message = f"{quoted(stop.case.id)} has `{key}`: a series is judged by stops to standstill"
                yield diagnose(entry.node.place, message, stop.role, f"leave `{key}` out")


def _drawn_twice(read: Sequence[tuple[PlannedStop, Entry]]) -> Iterator[Diagnostic]:
    """Yield every stop that an earlier one runs as well: one draw would count as two."""
    for number, (stop, entry) in enumerate(read):
        for earlier, _ in read[:number]:
            shared = sorted(_seeds(stop) & _seeds(earlier))
            if shared and stop.role == earlier.role and _conditions(stop) == _conditions(earlier):
                message = f"{quoted(stop.case.id)} is {quoted(earlier.case.id)} again with seed {shared[0]}"
                advice = "take other seeds, or a larger `repeat` of one of them"
                yield diagnose(entry.node.place, message, stop.role, advice)
                break


def _not_dry(read: Sequence[tuple[PlannedStop, Entry]]) -> Iterator[Diagnostic]:
    """Yield every dry stop on a rail in another condition."""
    for stop, entry in read:
        condition = stop.case.scenario.rail.condition.name
        if stop.role == "dry" and condition != "dry":
            message = f"the rail of {quoted(stop.case.id)} is {quoted(condition)}"
            yield diagnose(entry.node.place, message, "dry", "the reference is a stop on dry rail")


def _seeds(stop: PlannedStop) -> set[int]:
    """Return the seeds of a stop; none of a recorded one."""
    scenario = stop.case.scenario
    return set() if stop.recorded else set(range(scenario.seed, scenario.seed + scenario.repeat))


def _conditions(stop: PlannedStop) -> list[object]:
    """Return what decides how a stop goes, besides its seed."""
    return [getattr(stop.case.scenario, key) for key in _DECISIVE]


def _unmatched(read: Sequence[tuple[PlannedStop, Entry]]) -> Iterator[Diagnostic]:
    """Yield stops from a speed without its counterpart, and wet stops of another train than the dry ones."""
    for stop, entry in read:
        others = [each for each, _ in read if each.role != stop.role]
        same_speed = [each for each in others if each.speed == stop.speed]
        shown = stop.case.scenario.initial_speed.text
        if not same_speed:
            message = f"no {'wet' if stop.role == 'dry' else 'dry'} stop from {shown}"
            speeds = ", ".join(dict.fromkeys(each.case.scenario.initial_speed.text for each in others))
            yield diagnose(entry.node.place, message, stop.role, f"there are such from {speeds}")
        elif stop.role == "wet":
            for key in _differences_of_train(same_speed[0].case.scenario, stop.case.scenario):
                message = f"{quoted(stop.case.id)} and the dry stop from {shown} differ in {quoted(key)}"
                yield diagnose(entry.node.place, message, "wet", "the reference is of the same train")
