"""Recorded stops of validation and series files, beside their simulations."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from uictest import campaign, evaluation, field_data, rig, runs, scenario, validation
from uictest.cli.exit_codes import InvalidInputError
from uictest.cli.progress import announce_compilation, progress
from uictest.scenario import yaml
from uictest.units import KILOMETRE_PER_HOUR

_DISTANCE: Final = "braking_distance_m"


@dataclass(frozen=True, slots=True)
class _Stop:
    """A recorded stop: its file, the case as planned, and that from the recorded speed where it is usable."""

    file: runs.RecordedFile
    planned: validation.PlannedComparison
    case: scenario.Case
    not_counted: str


def load_plans(
    paths: Sequence[Path], overrides: Sequence[str] | None, trusted: Sequence[Path] | None
) -> list[validation.ValidationPlan]:
    """Return the validations of validation and series files. Raises ScenarioErrors, InvalidInputError."""
    plans: list[validation.ValidationPlan] = []
    for path in paths:
        if runs.is_series(path):
            plans += map(validation.plan_of_series, runs.load_series([path], overrides, None, trusted))
        else:
            plans.append(validation.load_validation(path, tuple(overrides or ()), trusted or ()))
    for plan in plans:
        if not plan.comparisons:
            raise InvalidInputError(
                f"uictest: {plan.path}: no stop names a recording: list them under `recordings`"
            )
    return plans


def validate_plan(
    plan: validation.ValidationPlan, jobs: int, trusted: Sequence[Path] | None
) -> tuple[validation.Validation, bool]:
    """Return a validation, and whether every simulation came to an end. Raises InvalidInputError."""
    read = dict(plan.inputs)
    stops = _counted_once([stop for each in plan.comparisons for stop in _stops(plan, each, read, trusted)])
    _require_distinct(plan, stops)
    usable = [stop for stop in stops if stop.file.stop is not None]
    simulated = _simulated([stop.case for stop in usable], jobs)
    results = dict(zip((stop.case.id for stop in usable), simulated, strict=True))
    compared = [_compared(stop, results.get(stop.case.id)) for stop in stops]
    conditions = [_conditions(stop) for stop in stops]
    pairs = list(map(validation.StopUnderConditions, compared, conditions))
    complete = all(each.outcome != "error" for each in simulated)
    return validation.validation_of(plan, pairs, read), complete


def read_reference(path: Path) -> validation.ValidationReference:
    """Return the validation that cases are held against. Raises InvalidInputError."""
    try:
        return validation.read_validation(path)
    except OSError as error:
        raise InvalidInputError(f"uictest: {path}: {error.strerror or error}") from error
    except ValueError as error:
        raise InvalidInputError(f"uictest: {path}: {error}") from error


def _stops(
    plan: validation.ValidationPlan,
    planned: validation.PlannedComparison,
    read: dict[str, str],
    trusted: Sequence[Path] | None,
) -> Iterator[_Stop]:
    """Yield the recorded stops of a comparison; the files read for it are added to `read`."""
    mapped, inputs = runs.named_map(planned.recorded.channel_map, trusted)
    read |= inputs
    for file in runs.read_files(planned.recorded.files, mapped):
        read[yaml.display_name(file.path)] = file.digest
        case_id = f"{planned.case.id}.{file.name}"
        case = replace(planned.case, id=case_id)
        if file.stop is not None:
            case = validation.as_recorded(planned.case, case_id, _speed(file.stop))
        yield _Stop(file, planned, case, _why_not_counted(plan, planned, file))


def _require_distinct(plan: validation.ValidationPlan, stops: Sequence[_Stop]) -> None:
    """Raise InvalidInputError where two stops have one id: each is compared with the simulation of its id."""
    files: dict[str, Path] = {}
    for stop in stops:
        if stop.case.id in files:
            raise InvalidInputError(
                f"uictest: {plan.path}: a second recorded stop {stop.case.id!r}, of {stop.file.path} and"
                f" {files[stop.case.id]}: rename one of the files"
            )
        files[stop.case.id] = stop.file.path


def _counted_once(stops: Sequence[_Stop]) -> list[_Stop]:
    """Return stops of which a copy of another's record does not count; the one that is tuned comes first."""
    first: dict[str, _Stop] = {}
    for stop in sorted(stops, key=lambda stop: not stop.planned.tuned):
        first.setdefault(stop.file.digest, stop)
    return [
        stop
        if first[stop.file.digest] is stop or stop.not_counted
        else replace(stop, not_counted=f"a copy of {yaml.display_name(first[stop.file.digest].file.path)}")
        for stop in stops
    ]


def _why_not_counted(
    plan: validation.ValidationPlan,
    planned: validation.PlannedComparison,
    file: runs.RecordedFile,
) -> str:
    if file.stop is None:
        return "; ".join(map(str, file.defects))
    nominal, speed = float(planned.case.scenario.initial_speed), _speed(file.stop)
    if abs(speed - nominal) > plan.speed_tolerance:
        stated = f"{nominal / KILOMETRE_PER_HOUR:.4g} km/h"
        within = f"{plan.speed_tolerance / KILOMETRE_PER_HOUR:.3g} km/h"
        return f"its scenario begins at {stated}, more than {within} away"
    return ""


def _speed(stop: field_data.RecordedStop) -> float:
    return float(stop.recording["speed"][0])


def _simulated(cases: Sequence[scenario.Case], jobs: int) -> list[evaluation.CaseResult]:
    announce_compilation(warm=rig.is_compiled(cases))
    with progress(sum(case.scenario.repeat for case in cases), quiet=False, unit="stops") as advance:
        done = campaign.run_cases(
            cases, jobs=jobs, recording=campaign.RecordingRequest("none"), on_stop=advance
        )
    if done.interrupted:
        raise KeyboardInterrupt
    return done.results


def _compared(stop: _Stop, simulated: evaluation.CaseResult | None) -> validation.ComparedStop:
    file = stop.file
    found = validation.ComparedStop(
        id=stop.case.id,
        recording=yaml.display_name(file.path),
        sha256=file.digest,
        initial_speed=float(stop.case.scenario.initial_speed),
        repeats=stop.case.scenario.repeat,
        tuned=stop.planned.tuned,
        not_counted=stop.not_counted,
    )
    if file.stop is None or simulated is None:
        return found
    recorded, _ = field_data.judge_recording(stop.case, file.stop)
    found = replace(
        found, recorded=validation.figures_of(recorded), simulated=validation.figures_of(simulated)
    )
    return replace(found, not_counted=found.not_counted or _missing_end(found, simulated))


def _missing_end(stop: validation.ComparedStop, simulated: evaluation.CaseResult) -> str:
    """Return why the stop has no end: conditions under which it had none were not validated."""
    if simulated.outcome == "error":
        return f"simulation: {simulated.reason}"
    for figures, of_what in ((stop.recorded, "record"), (stop.simulated, "simulation")):
        if math.isnan(figures[_DISTANCE]):
            return f"the {of_what} has no braking distance: it ends before standstill, or has a gap"
    return ""


def _conditions(stop: _Stop) -> list[validation.Conditions]:
    """Return the conditions of a stop as planned and as recorded."""
    parts: Mapping[str, Mapping[str, evaluation.EffectivePart]]
    parts = campaign.parts_of_cases([replace(stop.planned.case, id="planned"), stop.case])
    return [validation.conditions_of(each) for each in parts.values()]
