"""Run a validation: simulate the recorded stops, compare, write."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from uictest import report
from uictest.analysis import validation
from uictest.core import files
from uictest.judging import evaluation
from uictest.plans import scenario, validation as validation_plans
from uictest.running import campaign
from uictest.runs.observer import Observer
from uictest.runs.validation.stops import compared_stop, conditions_of_stop, recorded_stops


@dataclass(frozen=True, slots=True)
class ValidationRun:
    """A validation, and whether every simulation for it came to an end."""

    validation: validation.Validation
    complete: bool


def run_validation(
    plan: validation_plans.ValidationPlan, jobs: int, trusted: Sequence[Path] | None, observer: Observer
) -> ValidationRun:
    """Compare the recorded stops of a plan with their simulations.

    Raises InvalidInputError where a recording cannot be used, and KeyboardInterrupt.
    """
    stops, read = recorded_stops(plan, trusted)
    usable = [stop for stop in stops if stop.file.stop is not None]
    simulated = _simulated([stop.case for stop in usable], jobs, observer)
    results = dict(zip((stop.case.id for stop in usable), simulated, strict=True))
    compared = [compared_stop(stop, results.get(stop.case.id)) for stop in stops]
    pairs = list(map(validation.StopUnderConditions, compared, map(conditions_of_stop, stops)))
    complete = all(each.outcome != "error" for each in simulated)
    return ValidationRun(validation.validation_of(plan, pairs, read), complete)


def publish_validation(validated: validation.Validation, arguments: Sequence[str], output: Path) -> Path:
    """Write the files of a validation into a folder of its own below `output`; return it. Raises OSError."""
    manifest = report.run_manifest(arguments, None, validated.inputs, len(validated.stops))
    with files.RunFolder(output, f"validation-{report.run_name(datetime.now(UTC), manifest)}") as folder:
        for name, text in (
            (validation.RESULT, validation.validation_json(validated)),
            ("figures.csv", report.csv_text(*validation.figures_table(validated))),
            ("stops.csv", report.csv_text(*validation.stops_table(validated))),
            ("validation.md", report.document_markdown(validation.validation_document(validated))),
        ):
            files.write(folder.path, name, text)
        return folder.publish()


def _simulated(cases: Sequence[scenario.Case], jobs: int, observer: Observer) -> list[evaluation.CaseResult]:
    with observer.simulating(cases) as advance:
        done = campaign.run_cases(
            cases, jobs=jobs, recording=campaign.RecordingRequest("none"), on_stop=advance
        )
    if done.interrupted:
        raise KeyboardInterrupt
    return done.results
