"""Stops of the rig under the assumptions about the real train's."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, get_args

import numpy as np

import uictest
from studies.field.assumptions import DRY, INITIAL_SPEED, REAL_TRAIN, Assumptions, Brake, FieldStop
from studies.replay import CYCLE
from studies.stop_runner import StopRunner, seeded
from uictest import Case, Recording, rig
from uictest.plans.scenario import FrictionProfile

_SCENARIO = "slide-80"
_SLIPPERY = {"rail.friction": "0.1"}
"""Of a case from which the cleaning alone is taken: a rail of another condition needs a friction."""
_BATCH = 128
"""Stops that a thread runs in lanes at a time."""
_LONGER = 1.1
"""Duration of what is simulated to find the start of the clock, over the lead."""


@dataclass(frozen=True, slots=True)
class _ClockStart:
    """A stop from the brake command on, and the time and distance from there to the start of the clock."""

    case: Case
    before: Mapping[str, float]


class FieldRig:
    """Simulates the stop from 80 km/h under assumptions; each gives the same whatever the others.

    Args:
        stop_runner: loads the scenario of the stop.
    """

    def __init__(self, stop_runner: StopRunner) -> None:
        self._runner = stop_runner
        self._base = stop_runner.cases(_SCENARIO)[0]
        self._systems = {
            brake: stop_runner.cases(_SCENARIO, {"brake.system": brake})[0].scenario.brake.system
            for brake in get_args(Brake)
        }
        cleaned = stop_runner.cases(_SCENARIO, {"rail.condition": "wet-cleaning", **_SLIPPERY})[0]
        self._cleaning = cleaned.scenario.rail.condition.cleaning

    def build_up(self, brake: Brake) -> float:
        """Return the fill time of a brake system of the library, s."""
        return float(self._systems[brake].positions[self._base.scenario.brake.position].fill_time)

    def stops(self, assumptions: Sequence[Assumptions], seed: int = 0) -> list[FieldStop]:
        """Return what each stop gives, counted from the start of the clock at 80 km/h."""
        cases = [seeded(self.case(each), seed) for each in assumptions]
        starts = self._runner.map(_clock_start, list(zip(cases, assumptions, strict=True)))
        stops = self.in_lanes([start.case for start in starts])
        return [field_stop(stop, start.before) for stop, start in zip(stops, starts, strict=True)]

    def in_lanes(self, cases: Sequence[Case]) -> list[rig.SimulatedStop]:
        """Return the stop of every case; they run side by side in the lanes of a register."""
        batches = [cases[start : start + _BATCH] for start in range(0, len(cases), _BATCH)]
        return [stop for batch in self._runner.map(_side_by_side, batches) for stop in batch]

    def recording(self, assumptions: Assumptions) -> Recording:
        """Return the recording of a stop, from the brake command on."""
        return self._runner.recordings([self.case(assumptions)])[0]

    def case(self, assumptions: Assumptions) -> Case:
        """Return the case of the stop whose clock starts with the command."""
        scenario = self._base.scenario
        changes = {
            "rail": scenario.rail.model_copy(update=self._rail(assumptions)),
            "brake": scenario.brake.model_copy(update={"system": self._system(assumptions)}),
            "measures": _changed(scenario.measures, developed_time=self._developed_time(assumptions)),
        }
        return _with(self._base, **changes)

    def _rail(self, assumptions: Assumptions) -> dict[str, Any]:
        friction = {"friction": _profile(assumptions)}
        if assumptions.cleaning_energy is None:
            return friction
        numbers = {"energy": assumptions.cleaning_energy, "carry_over": assumptions.carry_over}
        return friction | {"cleaning": _changed(self._cleaning, **numbers)}

    def _system(self, assumptions: Assumptions) -> Any:
        system, position = self._systems[assumptions.brake], self._base.scenario.brake.position
        pad_friction = assumptions.pad_factor * system.disc.pad_friction
        filling = _changed(system.positions[position], fill_time=assumptions.fill_time)
        changes = {
            "disc": _changed(system.disc, pad_friction=pad_friction),
            "positions": {**system.positions, position: filling},
        }
        return system.model_copy(update=changes)

    def _developed_time(self, assumptions: Assumptions) -> float:
        """Return when the brake counts as developed, s: as long after its build-up as the library's has it.

        Without this, the least deceleration of a slow brake would be one of its build-up.
        """
        own, library = (
            systems.positions[self._base.scenario.brake.position]
            for systems in (self._systems[assumptions.brake], self._base.scenario.brake.system)
        )
        later = own.dead_time + assumptions.fill_time - library.dead_time - library.fill_time
        return float(self._base.scenario.measures.developed_time + later)


def _side_by_side(cases: Sequence[Case]) -> list[rig.SimulatedStop]:
    inputs = [rig.assemble(case) for case in cases]
    batch = rig.run_in_lanes(*rig.stacked(inputs))
    trains, wheelsets = batch.measures.view(np.recarray), batch.wheelset_measures.view(np.recarray)
    return [rig.SimulatedStop(*stop) for stop in zip(trains, wheelsets, strict=True)]


def _changed(model: Any, **numbers: float) -> Any:
    """Return a model with other numbers in the canonical units of its quantities."""
    quantities = {name: getattr(model, name) for name in numbers}
    changes = {name: type(old)(numbers[name], "", old.unit) for name, old in quantities.items()}
    return model.model_copy(update=changes)


def _profile(assumptions: Assumptions) -> FrictionProfile:
    slippery, place = assumptions.friction, f"{assumptions.place} m"
    frictions = {"constant": (slippery,), "dry first": (DRY, slippery), "dry last": (slippery, DRY)}
    points = [
        {"position": position, "friction": friction}
        for position, friction in zip(("0 m", place), frictions[assumptions.shape], strict=False)
    ]
    return FrictionProfile.model_validate({"points": tuple(points), "interpolation": "steps"})


def field_stop(stop: rig.SimulatedStop, before: Mapping[str, float]) -> FieldStop:
    """Return what a stop of the rig gives beside the real train's.

    Args:
        stop: from the brake command on.
        before: time and distance from there to the start of the clock; zero where left out.
    """
    wheelsets = stop.wheelset_measures
    return FieldStop(
        {name: float(stop.measures[name]) - before.get(name, 0.0) for name in REAL_TRAIN},
        tuple(int(count) for count in wheelsets.valve_actuations),
        float(wheelsets.maximum_slide.max()),
    )


def _clock_start(assumed: tuple[Case, Assumptions]) -> _ClockStart:
    """Return the stop whose brake is commanded so early that the train passes 80 km/h after the lead."""
    case, lead = assumed[0], assumed[1].lead
    if lead == 0.0:
        return _ClockStart(case, {})
    time, speed, _ = _begun(case, lead)
    before = 2.0 * INITIAL_SPEED - float(np.interp(lead, time, speed))
    earlier = replace(case, scenario=_changed(case.scenario, initial_speed=before))
    time, speed, distance = _begun(earlier, lead)
    start = float(np.interp(-INITIAL_SPEED, -speed, time))
    passed = {"braking_time": start, "braking_distance": float(np.interp(start, time, distance))}
    return _ClockStart(earlier, passed)


def _begun(case: Case, lead: float) -> tuple[Any, Any, Any]:
    """Return time, speed and distance of the beginning of a stop, for somewhat longer than the lead."""
    duration = _LONGER * lead + CYCLE
    begun = _with(case, simulation=_changed(case.scenario.simulation, maximum_duration=duration))
    recording = uictest.simulate(begun)
    return recording["time"], recording["speed"], recording["distance"]


def _with(case: Case, **changes: Any) -> Case:
    return replace(case, scenario=case.scenario.model_copy(update=changes))
