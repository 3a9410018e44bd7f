"""The stops of a series, as they are run, and what stops cannot be judged together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from operator import attrgetter
from typing import Final, NamedTuple

from uictest.core.series_measures import Rail
from uictest.plans import scenario as scenarios
from uictest.plans.scenario import LONGEST, PASS, Case, Criteria, Expectation
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Entry,
    Scalar,
    ScenarioErrors,
    diagnose,
    in_reading_order,
    quoted,
    single_error,
)
from uictest.plans.series.listing import ListedStops, recorded_twice
from uictest.plans.series.model import PlannedStop


def _differences_of_trains(dry: Case, wet: Case) -> Iterator[str]:
    """Yield what must be the same in both stops, for every car of a train, and is not: keys, quoted."""
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
        diagnostics: list[Diagnostic] = []
        read: list[tuple[PlannedStop, Entry]] = []
        for each in listed:
            try:
                read += [(stop, each.entry) for stop in self._of_entry(each)]
            except ScenarioErrors as errors:
                diagnostics.extend(errors.diagnostics)
        if not diagnostics:
            recordings = recorded_twice((stop.recorded, entry.node) for stop, entry in read)
            diagnostics += [*_repeated(read), *_not_to_standstill(read), *_drawn_twice(read), *recordings]
            diagnostics += [*_not_dry(read), *_unmatched(read)]
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
        for case in listed.cases_of(self.car):
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
        # The id of the series says which car is judged.
        name = f"{self.series}.{case.id if case.train is None else case.train.train}"
        if len(name) > LONGEST:
            message = f"the id {quoted(name)} is longer than {LONGEST} characters"
            raise single_error(reference.place, message, "name")
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
    drawn: dict[tuple[str, str], dict[int, PlannedStop]] = {}
    for stop, entry in read:
        earlier = drawn.setdefault((stop.role, repr(_conditions(stop))), {})
        shared = next((seed for seed in _seeds(stop) if seed in earlier), None)
        if shared is not None:
            message = f"{quoted(stop.case.id)} is {quoted(earlier[shared].case.id)} again with seed {shared}"
            advice = "take other seeds, or a larger `repeat` of one of them"
            yield diagnose(entry.node.place, message, stop.role, advice)
        earlier |= {seed: stop for seed in _seeds(stop) if seed not in earlier}


def _not_dry(read: Sequence[tuple[PlannedStop, Entry]]) -> Iterator[Diagnostic]:
    """Yield every dry stop on a rail in another condition."""
    for stop, entry in read:
        condition = stop.case.scenario.rail.condition.name
        if stop.role == "dry" and condition != "dry":
            message = f"the rail of {quoted(stop.case.id)} is {quoted(condition)}"
            yield diagnose(entry.node.place, message, "dry", "the reference is a stop on dry rail")


def _seeds(stop: PlannedStop) -> range:
    """Return the seeds of a stop; none of a recorded one."""
    scenario = stop.case.scenario
    return range(scenario.seed, scenario.seed + (0 if stop.recorded else scenario.repeat))


def _conditions(stop: PlannedStop) -> list[object]:
    """Return what decides how a stop goes, besides its seed."""
    return [getattr(car.scenario, key) for car in stop.case.cars for key in _DECISIVE]


def _unmatched(read: Sequence[tuple[PlannedStop, Entry]]) -> Iterator[Diagnostic]:
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
            yield diagnose(entry.node.place, message, stop.role, hint)
        elif stop.role == "wet":
            for key in _differences_of_trains(counterpart, stop.case):
                message = f"{quoted(stop.case.id)} and the dry stop from {shown} differ in {key}"
                yield diagnose(entry.node.place, message, "wet", "the reference is of the same train")
