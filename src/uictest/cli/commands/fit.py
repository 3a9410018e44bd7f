"""`uictest fit`: find what makes the simulated stop follow a recorded one."""

from __future__ import annotations

import json
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from uictest import field_data, fitting, recording, report, rig
from uictest.cli.compilation import announce_compilation
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import Expression, Overrides, Trusted, Verbosity
from uictest.cli.problems import InvalidInputError
from uictest.cli.recordings import (
    LowPass,
    MapName,
    Raster,
    Trigger,
    TriggerLead,
    channel_map,
    each_file,
    one_case,
)
from uictest.cli.streams import data, message
from uictest.recording import formats
from uictest.scenario import yaml

if TYPE_CHECKING:
    from uictest.scenario import Case

_RECORD_EVERY = 0.01
"""s"""
_CONFIDENCE = (
    "the confidence is that of the noise, and holds no calibration error of sensors, masses or brake"
)


def fit(
    context: typer.Context,
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The recorded stop.", show_default=False)],
    scenario: Annotated[
        Path, typer.Option("--scenario", metavar="FILE", help="Vehicle, brake and rail to begin with.")
    ],
    expression: Expression = None,
    overrides: Overrides = None,
    trusted: Trusted = None,
    breaks: Annotated[
        list[str] | None,
        typer.Option(
            "--break", metavar="PLACE", help="Where friction changes, such as '100 m'; may be repeated."
        ),
    ] = None,
    with_pads: Annotated[
        bool, typer.Option("--pads", help="Find the friction of the brake pads, too.")
    ] = False,
    map_name: MapName = "uictest",
    trigger: Trigger = None,
    trigger_lead: TriggerLead = None,
    raster: Raster = None,
    low_pass: LowPass = None,
    output: Annotated[
        Path,
        typer.Option(
            "-o", "--output", metavar="DIR", help="Folder in which each fit gets a folder of its own."
        ),
    ] = Path("reports"),
    verbosity: Verbosity = 0,
) -> ExitCode:
    """Find the friction of the rail under a recorded stop. Writes the scenario that has it.

    Exit code 1 says that the record cannot tell all of it: where nothing slid there is only a lower bound.
    """
    mapped, _ = channel_map(
        map_name, trusted, trigger=trigger, trigger_lead=trigger_lead, raster=raster, low_pass=low_pass
    )
    case = one_case(scenario, expression, list(overrides or ()), trusted)
    [stop] = each_file([file], lambda path: _stop(path, mapped))
    try:
        found = fitting.fit_stop(stop, case.scenario, _places(breaks or ()), with_pads=with_pads)
    except fitting.FitError as error:
        raise InvalidInputError(f"uictest: {file}: {error}") from error
    for line in _lines(found):
        data(line)
    announce_compilation(warm=rig.is_compiled([case]))
    place = _publish(
        context.obj.arguments, case, scenario, overrides or (), found, stop, output, trusted or ()
    )
    for defect in stop.defects:
        message(f"uictest: {file}: {defect}")
    message(f"uictest: fitted scenario, overlay and numbers in {place}")
    return ExitCode.MET if found.determined else ExitCode.MISSED


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


def _lines(found: fitting.Fit) -> list[str]:
    pads = [] if found.pad_factor is None else [str(found.pad_factor)]
    return [
        *map(str, found.friction),
        *pads,
        f"residual {found.residual:.4f} of the wheel load; {_CONFIDENCE}",
    ]


def _publish(
    arguments: Sequence[str],
    case: Case,
    scenario: Path,
    overrides: Sequence[str],
    found: fitting.Fit,
    stop: field_data.RecordedStop,
    output: Path,
    trusted: Sequence[Path],
) -> Path:
    """Write the fitted scenario, simulate it, and write how it compares; return the folder."""
    manifest = report.run_manifest(arguments, None, case.inputs, 1)
    statements = {key.strip(): text for key, _, text in (each.partition("=") for each in overrides)}
    with report.RunFolder(output, f"fit-{report.run_name(datetime.now(UTC), manifest)}") as folder:
        place = folder.path / f"{case.scenario.name}-fitted.yaml"
        try:
            recording.write_text_atomic(
                place, fitting.fitted_yaml(case, statements, found, scenario, folder.path)
            )
        except ValueError as error:
            raise InvalidInputError(f"uictest: {error}") from error
        simulated = _simulated(place, [scenario.parent, *trusted])
        both = fitting.overlay(stop, simulated)
        agreed = fitting.agreement(stop, simulated, both)
        formats.writer_of("csv")(both, folder.path / "overlay.csv")
        recording.write_text_atomic(folder.path / "overlay.svg", report.overlay_svg(both))
        document = fitting.fit_document(found, agreed, stop.choices)
        recording.write_text_atomic(folder.path / "fit.json", json.dumps(document, indent=2) + "\n")
        data(str(agreed))
        return folder.publish()


def _simulated(scenario: Path, trusted: Sequence[Path]) -> rig.SimulatedStop:
    from uictest.cli.cases import load_cases

    [fitted] = load_cases([scenario], None, None, trusted)
    return rig.simulate(fitted, record_every=_RECORD_EVERY)
