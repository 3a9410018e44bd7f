"""`uictest report`: a finished run in further formats."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import Verbosity, report_formats
from uictest.cli.problems import InvalidInputError
from uictest.cli.streams import data


def report(
    run: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder of a finished run, e.g. reports/latest.")
    ],
    formats: Annotated[
        str, typer.Option("--format", metavar="FORMATS", help="csv, xlsx, html, md; commas join several.")
    ] = "xlsx",
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Folder for the files [default: DIR]."),
    ] = None,
    verbosity: Verbosity = 0,
) -> ExitCode:
    """Write a finished run in further formats; shows the files it wrote.

    The page draws the stops whose recordings lie in the run's folder; --record all keeps all of them.
    """
    from uictest.report import ReportFormat, read_run, write_formats

    wanted = report_formats(formats, "--format")
    folder = run_folder(run)
    try:
        content = read_run(folder, traces=ReportFormat.HTML in wanted)
    except (OSError, ValueError) as error:
        raise InvalidInputError(f"uictest: {run} cannot be read as a run: {error}") from error
    place = folder if output is None else output
    place.mkdir(parents=True, exist_ok=True)
    for path in write_formats(place, content, wanted):
        data(str(path))
    return ExitCode.MET


def run_folder(place: Path) -> Path:
    """Return the folder of a run; `latest` may be a text file that names it, where links are impossible."""
    from uictest.report import latest_run

    if place.name == "latest" and not place.is_dir():
        return latest_run(place.parent) or place
    return place
