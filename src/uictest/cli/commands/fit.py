"""`uictest fit`: find the friction, and the cleaning, with which simulated stops follow recorded ones."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any

import typer

from uictest import controllers, report, rig, runs
from uictest.cli import options, recordings
from uictest.cli.options import argument, option
from uictest.cli.output import ExitCode, data, message
from uictest.cli.progress import compilation_shown
from uictest.core import files
from uictest.core.recording import formats
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.plans import scenario as scenarios
from uictest.plans.scenario import yaml
from uictest.recorded import field_data, fitting

_RECORD_EVERY = 0.01
"""s"""
_CONFIDENCE = "the confidence covers the noise, not the calibration of sensors, masses or brake"
_CONFIDENCE_OF_CLEANING = (
    "the confidence covers the noise, a delay of the wheel speeds and brake forces that are known to 1 %"
)

RecordedStopFiles = Annotated[
    list[Path],
    argument("FILE...", "Recording of the stop; several with --cleaning.", show_default=False),
]
ScenarioFile = Annotated[
    Path,
    option("--scenario FILE", "Scenario to start from: vehicle, brake, rail."),
]
Breaks = Annotated[
    list[str] | None,
    option("--break PLACE", "Where the friction changes, e.g. '100 m'. May be repeated."),
]
WithPads = Annotated[bool, option("--pads", "Also fit the friction of the brake pads.")]
WithCleaning = Annotated[
    bool,
    option("--cleaning", "Also fit how sliding cleans the rail, to all recordings together."),
]
Output = Annotated[Path, option("-o --output DIR", "Folder for fits; each fit gets a folder in it.")]


@dataclass(frozen=True, slots=True)
class _FittedStops:
    """Recorded stops by name, the case that they were fitted with, and the fit; `path` is the case's file."""

    stops: dict[str, field_data.RecordedStop]
    case: scenarios.Case
    path: Path
    overrides: Sequence[str]
    trusted: Sequence[Path]
    result: fitting.Fit | fitting.CleaningFit

    @property
    def cleaning(self) -> fitting.CleaningFit | None:
        """How sliding cleans the rail, if that was fitted."""
        return self.result if isinstance(self.result, fitting.CleaningFit) else None

    @property
    def fits(self) -> tuple[fitting.Fit, ...]:
        """The fit of each stop."""
        return self.result.stops if isinstance(self.result, fitting.CleaningFit) else (self.result,)

    def suffix(self, name: str) -> str:
        """Return what tells the files of a stop from those of the others."""
        return f"-{name}" if len(self.stops) > 1 else ""


def fit(
    context: typer.Context,
    files: RecordedStopFiles,
    scenario: ScenarioFile,
    expression: options.Expression = None,
    overrides: options.Overrides = None,
    breaks: Breaks = None,
    with_pads: WithPads = False,
    with_cleaning: WithCleaning = False,
    map_name: recordings.MapName = "uictest",
    trigger: recordings.Trigger = None,
    output: Output = Path("reports"),
) -> ExitCode:
    """Fit the rail friction to a recorded stop. Writes a scenario with the fitted friction.

    With --cleaning, several stops of the same train on rails of different friction may be given: energy and
    recovered friction are common to them.

    Exit code 1: the record does not determine all of it. Without sliding there is only a lower bound.
    """
    trusted = options.trusted_folders()
    _require_fitting_together(files, with_pads=with_pads, with_cleaning=with_cleaning)
    mapped, _ = recordings.channel_map(map_name, trusted, trigger)
    case = recordings.one_case(scenario, expression, overrides or (), trusted)
    stops = runs.each_file(files, lambda path: runs.read_stop(path, mapped))
    places = _places(breaks or ())
    result = _fit(files, stops, case, places, with_pads=with_pads, with_cleaning=with_cleaning)
    named = dict(zip(runs.stop_names(files), stops, strict=True))
    fitted = _FittedStops(named, case, scenario, overrides or (), trusted, result)
    data("\n".join(_lines(fitted)))
    with compilation_shown():
        folder = _publish(fitted, context.obj, output)
    for file, stop in zip(files, stops, strict=True):
        for defect in stop.defects:
            message(f"uictest: {file}: {defect}")
    files_of_stops = "scenarios, overlays" if len(stops) > 1 else "scenario, overlay"
    message(f"uictest: fitted {files_of_stops} and numbers in {folder}")
    return ExitCode.MET if result.determined else ExitCode.MISSED


def _require_fitting_together(files: Sequence[Path], *, with_pads: bool, with_cleaning: bool) -> None:
    if len(files) > 1 and not with_cleaning:
        raise typer.BadParameter(
            "several recordings are fitted together only with --cleaning; fit each on its own",
            param_hint="FILE...",
        )
    if with_pads and with_cleaning:
        raise typer.BadParameter(
            "pads and cleaning cannot be fitted together: fit the pads first, on a stop that hardly slides",
            param_hint="--pads",
        )


def _fit(
    files: Sequence[Path],
    stops: Sequence[field_data.RecordedStop],
    case: scenarios.Case,
    places: Sequence[float],
    *,
    with_pads: bool,
    with_cleaning: bool,
) -> fitting.Fit | fitting.CleaningFit:
    try:
        if with_cleaning:
            return fitting.fit_cleaning(stops, case.scenario, places)
        return fitting.fit_stop(stops[0], case.scenario, places, with_pads=with_pads)
    except fitting.FitError as error:
        raise runs.InvalidInputError(f"{', '.join(map(str, files))}: {error}") from error


def _places(texts: Sequence[str]) -> list[float]:
    try:
        places = [float(yaml.parse_quantity(text, "length")) for text in texts]
    except yaml.QuantityError as error:
        raise typer.BadParameter(f"{error}; {error.hint}", param_hint="--break") from error
    if sorted(set(places)) != places:
        raise typer.BadParameter("places must come in rising order", param_hint="--break")
    return places


def _lines(fitted: _FittedStops) -> list[str]:
    lines = [] if fitted.cleaning is None else [str(fitted.cleaning.estimate)]
    for name, fit in zip(fitted.stops, fitted.fits, strict=True):
        of_stop = f"{name}: " if len(fitted.stops) > 1 else ""
        lines += [f"{of_stop}{estimate}" for estimate in fit.friction]
        if fit.pad_factor is not None:
            lines.append(str(fit.pad_factor))
    return [*lines, f"residual {fitted.fits[0].residual:.4f} of the wheel load; {_covered(fitted)}"]


def _covered(fitted: _FittedStops) -> str:
    if fitted.cleaning is not None and fitted.cleaning.estimate.standing == "found":
        return _CONFIDENCE_OF_CLEANING
    return _CONFIDENCE


def _publish(fitted: _FittedStops, arguments: Sequence[str], output: Path) -> Path:
    """Write the fitted scenarios, simulate them, and write how well they agree; return the folder."""
    manifest = report.run_manifest(arguments, None, fitted.case.inputs, 1)
    with files.RunFolder(output, f"fit-{report.run_name(datetime.now(UTC), manifest)}") as folder:
        agreements = [
            _write_stop(fitted, name, fit, folder.path)
            for name, fit in zip(fitted.stops, fitted.fits, strict=True)
        ]
        document = _document(fitted, agreements)
        files.write(folder.path, "fit.json", json.dumps(document, indent=2) + "\n")
        return folder.publish()


def _document(fitted: _FittedStops, agreements: Sequence[fitting.Agreement]) -> dict[str, Any]:
    choices = [stop.choices for stop in fitted.stops.values()]
    if fitted.cleaning is None:
        return fitting.fit_document(fitted.fits[0], agreements[0], choices[0])
    return fitting.cleaning_document(fitted.cleaning, list(fitted.stops), agreements, choices)


def _write_stop(fitted: _FittedStops, name: str, fit: fitting.Fit, folder: Path) -> fitting.Agreement:
    """Write the fitted scenario of a stop, both stops over each other, and show how well they agree."""
    scenario = _write_scenario(fitted, name, fit, folder)
    simulated = _simulated(scenario, [fitted.path.parent, *fitted.trusted])
    recorded, suffix = fitted.stops[name], fitted.suffix(name)
    both = fitting.overlay(recorded, simulated)
    files.write(folder, f"overlay{suffix}.csv", formats.encoded(both, "csv"))
    files.write(folder, f"overlay{suffix}.svg", report.overlay_svg(both))
    agreement = fitting.agreement(recorded, simulated, both)
    data(f"{name}: {agreement}" if suffix else str(agreement))
    return agreement


def _write_scenario(fitted: _FittedStops, name: str, fit: fitting.Fit, folder: Path) -> Path:
    """Write the scenario with the fitted friction of a stop, and return its path."""
    path = folder / f"{fitted.case.scenario.name}-fitted{fitted.suffix(name)}.yaml"
    statements = {key.strip(): text for key, _, text in (each.partition("=") for each in fitted.overrides)}
    of_stop = None
    if len(fitted.stops) > 1:
        of_stop = name, f"{fitting.initial_speed(fitted.stops[name]) / KILOMETRE_PER_HOUR:.5g} km/h"
    try:
        text = fitting.fitted_yaml(
            fitted.case, statements, fit, fitted.path, folder, fitted.cleaning, of_stop
        )
    except ValueError as error:
        raise runs.InvalidInputError(f"{error}") from error
    files.write(folder, path.name, text)
    return path


def _simulated(scenario: Path, trusted: Sequence[Path]) -> rig.SimulatedStop:
    [case] = runs.load_cases([scenario], None, None, trusted)
    try:
        return rig.simulate(case, record_every=_RECORD_EVERY)
    except controllers.ControllerError as error:
        raise runs.InvalidInputError(f"the fitted scenario cannot be simulated: {error}") from error
