"""Run a validation: simulate the recorded stops, compare, write."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Final, NamedTuple

from uictest import report
from uictest.analysis import comparison, validation
from uictest.core import files
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging import evaluation
from uictest.plans import scenario, series
from uictest.plans.scenario import yaml
from uictest.recorded import field_data
from uictest.running import campaign
from uictest.runs.batch import simulate_cases
from uictest.runs.observer import Observer
from uictest.runs.recorded import RecordedFile, named_map, read_files
from uictest.runs.scenario_files import InvalidInputError, is_series, load_series

DRAWN: Final = 4
"""Recorded stops that the page draws with their simulations, those furthest off; chosen."""


@dataclass(frozen=True, slots=True)
class RecordedStopOfPlan:
    """A recorded stop: its file, the case as planned, and that from the recorded speed where it is usable."""

    file: RecordedFile
    planned: series.PlannedComparison
    case: scenario.Case
    not_counted: str


def recorded_stops(
    plan: series.ValidationPlan, trusted: Sequence[Path] | None
) -> tuple[list[RecordedStopOfPlan], dict[str, str]]:
    """Return the recorded stops of a plan, and every file that was read with its SHA-256.

    Raises InvalidInputError where a file cannot be read, or two stops have one id.
    """
    read = dict(plan.inputs)
    stops = _counted_once(
        [stop for comparison in plan.comparisons for stop in _planned_stops(plan, comparison, read, trusted)]
    )
    files: dict[str, Path] = {}
    for stop in stops:  # each is compared with the simulation of its id
        if stop.case.id in files:
            raise InvalidInputError(
                f"{plan.path}: a second recorded stop {stop.case.id!r}, of {stop.file.path} and"
                f" {files[stop.case.id]}: rename one of the files"
            )
        files[stop.case.id] = stop.file.path
    return stops, read


def compared_stop(
    stop: RecordedStopOfPlan, simulated: evaluation.CaseResult | None
) -> validation.ComparedStop:
    """Return a recorded stop with its simulation, if it has one."""
    file = stop.file
    compared = validation.ComparedStop(
        id=stop.case.id,
        recording=yaml.display_name(file.path),
        sha256=file.digest,
        initial_speed=float(stop.case.scenario.initial_speed),
        repeats=stop.case.scenario.repeat,
        seed=None if file.stop is None else stop.case.scenario.seed,
        tuned=stop.planned.tuned,
        not_counted=stop.not_counted,
    )
    if file.stop is None or simulated is None:
        return compared
    recorded, _ = field_data.judge_recording(stop.case, file.stop)
    compared = replace(
        compared, recorded=validation.figures_of(recorded), simulated=validation.figures_of(simulated)
    )
    return replace(compared, not_counted=compared.not_counted or _missing_end(compared, simulated))


def _planned_stops(
    plan: series.ValidationPlan,
    planned: series.PlannedComparison,
    read: dict[str, str],
    trusted: Sequence[Path] | None,
) -> Iterator[RecordedStopOfPlan]:
    """Yield the recorded stops of a comparison; the files read for it are added to `read`."""
    mapped, inputs = named_map(planned.recorded.channel_map, trusted)
    read |= inputs
    for file in read_files(planned.recorded.files, mapped):
        read[yaml.display_name(file.path)] = file.digest
        case_id = f"{planned.case.id}.{file.name}"
        case = replace(planned.case, id=case_id)
        if file.stop is not None:
            case = validation.as_recorded(planned.case, case_id, _initial_speed(file.stop), file.digest)
        yield RecordedStopOfPlan(file, planned, case, _why_not_counted(plan, planned, file))


def _counted_once(stops: Sequence[RecordedStopOfPlan]) -> list[RecordedStopOfPlan]:
    """Return stops of which a copy of another's record does not count; the one that is tuned comes first."""
    first: dict[str, RecordedStopOfPlan] = {}
    for stop in sorted(stops, key=lambda stop: not stop.planned.tuned):
        first.setdefault(stop.file.digest, stop)
    return [
        stop
        if first[stop.file.digest] is stop or stop.not_counted
        else replace(stop, not_counted=f"a copy of {yaml.display_name(first[stop.file.digest].file.path)}")
        for stop in stops
    ]


def _why_not_counted(
    plan: series.ValidationPlan, planned: series.PlannedComparison, file: RecordedFile
) -> str:
    if file.stop is None:
        return "; ".join(map(str, file.defects))
    nominal, speed = float(planned.case.scenario.initial_speed), _initial_speed(file.stop)
    if abs(speed - nominal) > plan.speed_tolerance:
        stated = f"{nominal / KILOMETRE_PER_HOUR:.4g} km/h"
        within = f"{plan.speed_tolerance / KILOMETRE_PER_HOUR:.3g} km/h"
        return f"its scenario begins at {stated}, more than {within} away"
    return ""


def _initial_speed(stop: field_data.RecordedStop) -> float:
    return float(stop.recording["speed"][0])


def _missing_end(stop: validation.ComparedStop, simulated: evaluation.CaseResult) -> str:
    """Return the reason for which the stop has no end. Not validated: stops without one."""
    if simulated.outcome == "error":
        return f"simulation: {simulated.reason}"
    for figures, of_what in ((stop.recorded, "record"), (stop.simulated, "simulation")):
        if math.isnan(figures["braking_distance_m"]):
            return f"the {of_what} has no braking distance: it ends before standstill, or has a gap"
    return ""


class ValidationRun(NamedTuple):
    """A validation, whether every simulation for it came to an end, and the stops that are drawn."""

    validation: validation.Validation
    complete: bool
    drawn: Sequence[comparison.Overlay]


def run_validation(
    plan: series.ValidationPlan, jobs: int, trusted: Sequence[Path] | None, observer: Observer
) -> ValidationRun:
    """Compare the recorded stops of a plan with their simulations.

    Raises InvalidInputError where a recording cannot be used, and KeyboardInterrupt.
    """
    stops, read = recorded_stops(plan, trusted)
    usable = [stop for stop in stops if stop.file.stop is not None]
    settings = campaign.RunSettings(jobs, campaign.RecordingRequest("all"))
    drawing = _FurthestOff({stop.case.id: stop for stop in usable if not stop.not_counted})
    cases = [stop.case for stop in usable]
    simulated = simulate_cases(cases, settings, observer, drawing.add, unit="stops").whole()
    results = dict(zip((stop.case.id for stop in usable), simulated, strict=True))
    pairs: list[validation.StopUnderConditions] = []
    for stop in stops:
        parts = campaign.parts_of_cases([replace(stop.planned.case, id="planned"), stop.case])
        conditions = [validation.conditions_of(of_case) for of_case in parts.values()]
        compared = compared_stop(stop, results.get(stop.case.id))
        pairs.append(validation.StopUnderConditions(compared, conditions))
    complete = all(result.outcome != "error" for result in simulated)
    return ValidationRun(validation.validation_of(plan, pairs, read), complete, drawing.overlays)


class _FurthestOff:
    """Lays the simulations of recorded stops, given by id, over the records: of those furthest off."""

    def __init__(self, stops: Mapping[str, RecordedStopOfPlan]) -> None:
        self._stops = stops
        self._drawn: list[tuple[float, comparison.Overlay]] = []

    @property
    def overlays(self) -> list[comparison.Overlay]:
        """The stops drawn, the furthest off first."""
        return [overlay for _, overlay in self._drawn]

    def add(self, run: campaign.CaseRun) -> None:
        """Draw a simulated stop, unless there are enough that are further off."""
        stop = self._stops.get(run.result.id)
        if stop is None or stop.file.stop is None or run.recording is None:
            return
        recorded, samples = field_data.judge_recording(stop.case, stop.file.stop)
        off = validation.relative_difference(
            validation.figures_of(recorded), validation.figures_of(run.result)
        )
        if math.isnan(off):
            return
        if len(self._drawn) == DRAWN and abs(off) <= self._drawn[-1][0]:
            return
        overlay = comparison.stops_laid_over(run.result.id, (samples, run.recording))
        self._drawn.append((abs(off), overlay))
        self._drawn = sorted(self._drawn, key=lambda drawn: -drawn[0])[:DRAWN]


def publish_validation(run: ValidationRun, arguments: Sequence[str], output: Path) -> Path:
    """Write the files of a validation into a folder of its own below `output`; return it. Raises OSError."""
    validated = run.validation
    manifest = report.run_manifest(arguments, None, validated.inputs, len(validated.stops))
    publication = report.Publication(
        document=validation.validation_document(validated),
        tables=[validation.figures_table(validated), validation.stops_table(validated)],
        page=lambda: validation.validation_html(validated, run.drawn),
        texts={validation.RESULT: validation.validation_json(validated)},
    )
    with files.RunFolder(output, f"validation-{report.run_name(datetime.now(UTC), manifest)}") as folder:
        report.publish(publication, ("csv", "html", "md"), folder.path)
        return folder.publish()


def load_validations(
    paths: Sequence[Path], overrides: Sequence[str] | None = None, trusted: Sequence[Path] | None = None
) -> list[series.ValidationPlan]:
    """Return the validations of validation and series files. Raises ScenarioErrors, InvalidInputError."""
    plans: list[series.ValidationPlan] = []
    for path in paths:
        if is_series(path):
            plans += map(series.plan_of_series, load_series([path], overrides, None, trusted))
        else:
            plans.append(series.load_validation(path, tuple(overrides or ()), trusted or ()))
    for plan in plans:
        if not plan.comparisons:
            raise InvalidInputError(f"{plan.path}: no stop names a recording: list them under `recordings`")
    return plans
