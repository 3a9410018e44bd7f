"""`uictest report`: a finished run or sweep in further formats."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from uictest.cli.exit_codes import ExitCode
from uictest.cli.folders import holds_sweep, why_no_run
from uictest.cli.options import Verbosity, report_formats
from uictest.cli.problems import InvalidInputError
from uictest.cli.streams import data

if TYPE_CHECKING:
    from uictest.report import ReportFormat


def report(
    run: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder of a finished run or sweep, e.g. reports/latest.")
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
    """Write a finished run or sweep in further formats. Shows the files it wrote.

    The page draws the stops whose recordings lie in the run's folder; --record all keeps all of them.
    """
    from uictest.report import SWEEP_RESULTS

    wanted = report_formats(formats, "--format")
    folder = run_folder(run)
    write = _write_sweep if (folder / SWEEP_RESULTS).is_file() else _write_run
    for path in write(folder, folder if output is None else output, wanted):
        data(str(path))
    return ExitCode.MET


def _write_run(folder: Path, place: Path, wanted: Sequence[ReportFormat]) -> list[Path]:
    from uictest.report import ReportFormat, read_run, write_formats

    if holds_sweep(folder):
        raise InvalidInputError(
            f"uictest: {folder} holds a sweep that is not finished: give its command again, "
            "or put its shares together with --merge"
        )
    if reason := why_no_run(folder):
        raise InvalidInputError(f"uictest: {reason}; report takes the folder of a finished run or sweep")
    with _read_as("run", folder, OSError, ValueError):
        content = read_run(folder, traces=ReportFormat.HTML in wanted)
    place.mkdir(parents=True, exist_ok=True)
    return write_formats(place, content, wanted)


def _write_sweep(folder: Path, place: Path, wanted: Sequence[ReportFormat]) -> list[Path]:
    from uictest.report import ReportFormat, read_sweep, write_sweep_formats

    with _read_as("sweep", folder, OSError, ValueError):
        content = read_sweep(folder, traces=ReportFormat.HTML in wanted)
    place.mkdir(parents=True, exist_ok=True)
    # The cases are read while the workbook is written.
    with _read_as("sweep", folder, ValueError):
        return write_sweep_formats(place, content, wanted)


@contextlib.contextmanager
def _read_as(kind: str, folder: Path, *errors: type[Exception]) -> Iterator[None]:
    try:
        yield
    except errors as error:
        raise InvalidInputError(f"uictest: {folder} cannot be read as a {kind}: {error}") from error


def run_folder(place: Path) -> Path:
    """Return the folder of a run; `latest` may be a text file that names it, where links are impossible."""
    from uictest.report import latest_run

    if place.name == "latest" and not place.is_dir():
        return latest_run(place.parent) or place
    return place
