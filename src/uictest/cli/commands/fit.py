"""`uictest fit`: find the friction with which the simulated stop follows a recorded one."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from uictest import controllers, report, rig, runs
from uictest.cli import options, recordings
from uictest.cli.options import argument, option
from uictest.cli.output import ExitCode, data, message
from uictest.core import files
from uictest.core.recording import formats
from uictest.plans import scenario as scenarios
from uictest.plans.scenario import yaml
from uictest.recorded import field_data, fitting

_RECORD_EVERY = 0.01
"""s"""

RecordedStopFile = Annotated[Path, argument("FILE", "Recording of the stop.", show_default=False)]
ScenarioFile = Annotated[Path, option("--scenario FILE", "Scenario to start from: vehicle, brake, rail.")]
Breaks = Annotated[
    list[str] | None, option("--break PLACE", "Where the friction changes, e.g. '100 m'. May be repeated.")
]
WithPads = Annotated[bool, option("--pads", "Also fit the friction of the brake pads.")]
Output = Annotated[Path, option("-o --output DIR", "Folder for fits; each fit gets a folder in it.")]


@dataclass(frozen=True, slots=True)
class _FittedStop:
    """A recorded stop, the case that it was fitted with, and the fit; `path` is the file of the case."""

    stop: field_data.RecordedStop
    case: scenarios.Case
    path: Path
    overrides: Sequence[str]
    trusted: Sequence[Path]
    fit: fitting.Fit


def fit(
    context: typer.Context,
    file: RecordedStopFile,
    scenario: ScenarioFile,
    expression: options.Expression = None,
    overrides: options.Overrides = None,
    breaks: Breaks = None,
    with_pads: WithPads = False,
    map_name: recordings.MapName = "uictest",
    trigger: recordings.Trigger = None,
    output: Output = Path("reports"),
) -> ExitCode:
    """Fit the rail friction to a recorded stop. Writes a scenario with the fitted friction.

    Exit code 1: the record does not determine all of it. Without sliding there is only a lower bound.
    """
    trusted = options.trusted_folders()
    mapped, _ = recordings.channel_map(map_name, trusted, trigger)
    case = recordings.one_case(scenario, expression, overrides or (), trusted)
    [stop] = runs.each_file([file], lambda path: runs.read_stop(path, mapped))
    positions = _parsed_positions(breaks or ())
    try:
        result = fitting.fit_stop(stop, case.scenario, positions, with_pads=with_pads)
    except fitting.FitError as error:
        raise runs.InvalidInputError(f"{file}: {error}") from error
    residual = f"residual {result.residual:.4f} of the wheel load; {fitting.COVERED}"
    data("\n".join([*map(str, result.estimates), residual, *filter(None, [result.remark])]))
    fitted = _FittedStop(stop, case, scenario, overrides or (), trusted, result)
    folder = _publish(fitted, context.obj, output)
    for defect in stop.defects:
        message(f"uictest: {file}: {defect}")
    message(f"uictest: fitted scenario, overlay and numbers in {folder}")
    return ExitCode.MET if result.determined else ExitCode.MISSED


def _parsed_positions(texts: Sequence[str]) -> list[float]:
    """Return the positions along the track at which the friction changes, m."""
    try:
        positions = [float(yaml.parse_quantity(text, "length")) for text in texts]
    except yaml.QuantityError as error:
        raise typer.BadParameter(f"{error}; {error.hint}", param_hint="--break") from error
    if sorted(set(positions)) != positions:
        raise typer.BadParameter("places must come in rising order", param_hint="--break")
    return positions


def _publish(fitted: _FittedStop, arguments: Sequence[str], output: Path) -> Path:
    """Write the fitted scenario, simulate it, and write how well it agrees; return the folder."""
    manifest = report.run_manifest(arguments, None, fitted.case.inputs, 1)
    with files.RunFolder(output, f"fit-{report.run_name(datetime.now(UTC), manifest)}") as folder:
        scenario = _write_scenario(fitted, folder.path)
        [case] = runs.load_cases([scenario], None, None, [fitted.path.parent, *fitted.trusted])
        try:
            simulated = rig.simulate(case, record_every=_RECORD_EVERY)
        except controllers.ControllerError as error:
            reason = f"the fitted scenario cannot be simulated: {error}"
            raise runs.InvalidInputError(reason) from error
        both = fitting.overlay(fitted.stop, simulated)
        files.write(folder.path, "overlay.csv", formats.encoded(both, "csv"))
        files.write(folder.path, "overlay.svg", report.overlay_svg(both))
        agreement = fitting.agreement(fitted.stop, simulated, both)
        data(str(agreement))
        document = fitting.fit_document(fitted.fit, agreement, fitted.stop.choices)
        files.write(folder.path, "fit.json", json.dumps(document, indent=2) + "\n")
        return folder.publish()


def _write_scenario(fitted: _FittedStop, folder: Path) -> Path:
    """Write the scenario with the fitted friction, and return its path."""
    path = folder / f"{fitted.case.scenario.name}-fitted.yaml"
    statements = {
        key.strip(): text for key, _, text in (statement.partition("=") for statement in fitted.overrides)
    }
    try:
        text = fitting.fitted_yaml(fitted.case, statements, fitted.fit, fitted.path, folder)
    except ValueError as error:
        raise runs.InvalidInputError(f"{error}") from error
    files.write(folder, path.name, text)
    return path
