"""Read the stops of a series from the scenarios that it names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from uictest.core.series_measures import Rail
from uictest.plans import scenario as scenarios
from uictest.plans.scenario import LONGEST, Case, Criteria, Files, load_file
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Entry,
    Map,
    Override,
    Scalar,
    ScenarioErrors,
    diagnose,
    entry_at,
    in_reading_order,
    quoted,
    single_error,
)
from uictest.plans.series.model import SeriesFile, Stops
from uictest.plans.series.series import PlannedStop, Role
from uictest.plans.series.stop_entry import differences_of_train, recorded_by, scenario_of, values_set_by

_DECISIVE: Final = ("vehicle", "initial_speed", "brake", "rail", "rig", "controller", "faults", "simulation")
"""Keys of a scenario that decide, with the seed, how the stop goes."""


@dataclass(frozen=True)
class StopReader:
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
                entry = _entry(tree, role, number)
                try:
                    read += [(stop, entry) for stop in self._of_entry(role, entry)]
                except ScenarioErrors as errors:
                    diagnostics.extend(errors.diagnostics)
        if not diagnostics:
            diagnostics.extend(_repeated(read))
            diagnostics.extend(_drawn_twice(read))
            diagnostics.extend(_recorded_twice(read))
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
        reference = scenario_of(entry.node)
        self.files.beside(reference, role)
        path = self.files.path_of(reference, role)
        cases = load_file(path, [*self.common, *values_set_by(entry.node), *self.last], self.files)
        recorded = recorded_by(entry.node, self.files)
        if recorded is not None and len(cases) > 1:
            message = f"recordings belong to one stop, the scenario has {len(cases)} cases"
            raise single_error(reference.place, message, role, "give each its own entry, with `set`")
        for case in cases:
            rail: Rail = "uncleaned" if case.scenario.rail.cleaning_in_force is None else "cleaned"
            yield PlannedStop(role, self._case(case, reference), recorded, "" if role == "dry" else rail)

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


def _entry(tree: Map, role: Role, number: int) -> Entry:
    entry, _ = entry_at(tree, (role, number))
    return entry


def _repeated(read: Sequence[tuple[PlannedStop, Entry]]) -> Iterator[Diagnostic]:
    """Yield every case with the id of an earlier one."""
    seen: set[str] = set()
    for stop, entry in read:
        if stop.case.id in seen:
            message = f"a second stop {quoted(stop.case.id)}"
            yield diagnose(entry.node.place, message, stop.role, "tell them apart by values under `set`")
        seen.add(stop.case.id)


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


def _recorded_twice(read: Sequence[tuple[PlannedStop, Entry]]) -> Iterator[Diagnostic]:
    """Yield every recording that is named before: one stop would count as two."""
    seen: set[Path] = set()
    for stop, entry in read:
        for file in stop.recorded.files if stop.recorded else ():
            if file.resolve() in seen:
                message = f"{quoted(file.name)} is named twice"
                yield diagnose(entry.node.place, message, "recordings", "each recording is one stop")
            seen.add(file.resolve())


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
            for key in differences_of_train(same_speed[0].case.scenario, stop.case.scenario):
                message = f"{quoted(stop.case.id)} and the dry stop from {shown} differ in {quoted(key)}"
                yield diagnose(entry.node.place, message, "wet", "the reference is of the same train")
