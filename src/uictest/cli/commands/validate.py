"""`uictest validate`: recorded stops against their simulation."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from uictest import recording, report, validation
from uictest.cli import options
from uictest.cli.exit_codes import ExitCode, worst
from uictest.cli.output import data, message, terminal_width
from uictest.cli.recorded_validation import load_plans, validate_plan

Files = Annotated[
    list[Path],
    typer.Argument(
        metavar="FILE...",
        help="Validation files (.yaml), or series that name recordings.",
        show_default=False,
    ),
]
Output = Annotated[
    Path,
    typer.Option("-o", "--output", metavar="DIR", help="Folder for validations; each gets a folder in it."),
]


def validate(
    context: typer.Context,
    files: Files,
    overrides: options.Overrides = None,
    trusted: options.Trusted = None,
    jobs: options.Jobs = "auto",  # type: ignore[assignment]  # typer hands the text to the option's parser
    output: Output = Path("reports"),
    shown: options.ListFormat = options.PlainFormat.TEXT,
    verbosity: options.Verbosity = 0,
) -> ExitCode:
    """Compare recorded stops with their simulation: bias and spread of every figure, and the domain.

    Writes validation.json, which `uictest run --validated` reads, figures.csv, stops.csv and validation.md.
    Exit code 1: a recorded stop cannot be counted; 3: a simulation failed.
    """
    if shown is options.PlainFormat.JSON and len(files) > 1:
        raise typer.BadParameter("prints the document of one file; name one", param_hint="--format json")
    codes = [ExitCode.MET]
    for plan in load_plans(files, overrides, trusted):
        validated, complete = validate_plan(plan, jobs, trusted)
        place = _publish(validated, context.obj.arguments, output)
        if shown is options.PlainFormat.JSON:
            data(validation.validation_json(validated).rstrip("\n"))
        else:
            width = terminal_width(sys.stdout)
            data("\n".join(validation.validation_lines(validated, width, every_figure=verbosity > 0)))
        counted = f"{len(validated.counted)} of {report.counted(len(validated.stops), 'recorded stop')}"
        message(f"uictest: {plan.name}: {counted} counted; validation in {place}")
        codes.append(_code(validated, complete=complete))
    return worst(*codes)


def _code(validated: validation.Validation, *, complete: bool) -> ExitCode:
    if not complete:
        return ExitCode.ERROR
    return ExitCode.MISSED if any(stop.not_counted for stop in validated.stops) else ExitCode.MET


def _publish(validated: validation.Validation, arguments: Sequence[str], output: Path) -> Path:
    """Write the files of a validation, and return their folder. Raises OSError."""
    manifest = report.run_manifest(arguments, None, validated.inputs, len(validated.stops))
    with report.RunFolder(output, f"validation-{report.run_name(datetime.now(UTC), manifest)}") as folder:
        for name, text in (
            ("validation.json", validation.validation_json(validated)),
            ("figures.csv", validation.figures_csv(validated)),
            ("stops.csv", validation.stops_csv(validated)),
            ("validation.md", validation.markdown(validated)),
        ):
            recording.write_text_atomic(folder.path / name, text)
        return folder.publish()
