"""`uictest fit`: find the friction with which the simulated stop follows a recorded one."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from uictest import field_data, fitting, recording, report, rig, scenario as scenarios
from uictest.cli import options, recordings
from uictest.cli.cases import load_cases
from uictest.cli.exit_codes import ExitCode, InvalidInputError
from uictest.cli.output import data, message
from uictest.cli.progress import announce_compilation
from uictest.recording import formats
from uictest.scenario import yaml

_RECORD_EVERY = 0.01
"""s"""
_CONFIDENCE = "the confidence covers the noise, not the calibration of sensors, masses or brake"

RecordedStopFile = Annotated[
    Path, typer.Argument(metavar="FILE", help="Recording of the stop.", show_default=False)
]
ScenarioFile = Annotated[
    Path,
    typer.Option("--scenario", metavar="FILE", help="Scenario to start from: vehicle, brake, rail."),
]
Breaks = Annotated[
    list[str] | None,
    typer.Option(
        "--break", metavar="PLACE", help="Where the friction changes, e.g. '100 m'. May be repeated."
    ),
]
WithPads = Annotated[bool, typer.Option("--pads", help="Also fit the friction of the brake pads.")]
Output = Annotated[
    Path, typer.Option("-o", "--output", metavar="DIR", help="Folder for fits; each fit gets a folder in it.")
]


@dataclass(frozen=True, slots=True)
class _FittedStop:
    """A recorded stop, the case that it was fitted with, and the fit; `path` is the file of the scenario."""

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
    trusted: options.Trusted = None,
    breaks: Breaks = None,
    with_pads: WithPads = False,
    map_name: recordings.MapName = "uictest",
    trigger: recordings.Trigger = None,
    trigger_lead: recordings.TriggerLead = None,
    raster: recordings.Raster = None,
    low_pass: recordings.LowPass = None,
    output: Output = Path("reports"),
    verbosity: options.Verbosity = 0,
) -> ExitCode:
    """Fit the rail friction to a recorded stop. Writes a scenario with the fitted friction.

    Exit code 1: the record does not determine all of it. Without sliding there is only a lower bound.
    """
    mapped, _ = recordings.channel_map(
        map_name, trusted, trigger=trigger, trigger_lead=trigger_lead, raster=raster, low_pass=low_pass
    )
    case = recordings.one_case(scenario, expression, overrides or (), trusted)
    [stop] = recordings.each_file([file], lambda path: _stop(path, mapped))
    result = _fit(file, stop, case, _places(breaks or ()), with_pads=with_pads)
    data("\n".join(_lines(result)))
    announce_compilation(warm=rig.is_compiled([case]))
    fitted = _FittedStop(stop, case, scenario, overrides or (), trusted or (), result)
    folder = _publish(fitted, context.obj.arguments, output)
    for defect in stop.defects:
        message(f"uictest: {file}: {defect}")
    message(f"uictest: fitted scenario, overlay and numbers in {folder}")
    return ExitCode.MET if result.determined else ExitCode.MISSED


def _fit(
    file: Path,
    stop: field_data.RecordedStop,
    case: scenarios.Case,
    places: Sequence[float],
    *,
    with_pads: bool,
) -> fitting.Fit:
    try:
        return fitting.fit_stop(stop, case.scenario, places, with_pads=with_pads)
    except fitting.FitError as error:
        raise InvalidInputError(f"uictest: {file}: {error}") from error


def _stop(path: Path, mapped: field_data.ChannelMap) -> field_data.RecordedStop:
    try:
        return field_data.stop_in(path, mapped)
    except field_data.UnusableError as error:
        raise formats.UnreadableError(str(error)) from error


def _places(texts: Sequence[str]) -> list[float]:
    try:
        places = [float(yaml.parse_quantity(text, "length")) for text in texts]
    except yaml.QuantityError as error:
        raise typer.BadParameter(f"{error}; {error.hint}", param_hint="--break") from error
    if sorted(set(places)) != places:
        raise typer.BadParameter("places must come in rising order", param_hint="--break")
    return places


def _lines(fit: fitting.Fit) -> list[str]:
    pads = [] if fit.pad_factor is None else [str(fit.pad_factor)]
    return [
        *map(str, fit.friction),
        *pads,
        f"residual {fit.residual:.4f} of the wheel load; {_CONFIDENCE}",
    ]


def _publish(fitted: _FittedStop, arguments: Sequence[str], output: Path) -> Path:
    """Write the fitted scenario, simulate it, and write how well it agrees; return the folder."""
    manifest = report.run_manifest(arguments, None, fitted.case.inputs, 1)
    with report.RunFolder(output, f"fit-{report.run_name(datetime.now(UTC), manifest)}") as folder:
        scenario = _write_scenario(fitted, folder.path)
        simulated = _simulated(scenario, [fitted.path.parent, *fitted.trusted])
        _write_agreement(fitted, simulated, folder.path)
        return folder.publish()


def _write_scenario(fitted: _FittedStop, folder: Path) -> Path:
    """Write the scenario with the fitted friction, and return its path."""
    path = folder / f"{fitted.case.scenario.name}-fitted.yaml"
    statements = {key.strip(): text for key, _, text in (each.partition("=") for each in fitted.overrides)}
    try:
        text = fitting.fitted_yaml(fitted.case, statements, fitted.fit, fitted.path, folder)
    except ValueError as error:
        raise InvalidInputError(f"uictest: {error}") from error
    recording.write_text_atomic(path, text)
    return path


def _write_agreement(fitted: _FittedStop, simulated: rig.SimulatedStop, folder: Path) -> None:
    """Write both stops over each other and how well they agree, and show the latter."""
    both = fitting.overlay(fitted.stop, simulated)
    agreement = fitting.agreement(fitted.stop, simulated, both)
    formats.writer_of("csv")(both, folder / "overlay.csv")
    recording.write_text_atomic(folder / "overlay.svg", report.overlay_svg(both))
    document = fitting.fit_document(fitted.fit, agreement, fitted.stop.choices)
    recording.write_text_atomic(folder / "fit.json", json.dumps(document, indent=2) + "\n")
    data(str(agreement))


def _simulated(scenario: Path, trusted: Sequence[Path]) -> rig.SimulatedStop:
    [case] = load_cases([scenario], None, None, trusted)
    return rig.simulate(case, record_every=_RECORD_EVERY)
