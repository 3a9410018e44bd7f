"""`uictest report`: write a finished run or sweep in more formats."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated

import typer

from uictest import report as reports, runs
from uictest.cli.exit_codes import ExitCode, InvalidInputError
from uictest.cli.options import Verbosity, report_formats
from uictest.cli.output import data


def report(
    run: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder of a finished run or sweep, e.g. reports/latest.")
    ],
    formats: Annotated[
        str,
        typer.Option(
            "--format",
            metavar="FORMATS",
            help=f"Formats, joined by commas: {', '.join(reports.format_names())}; junit for runs only.",
        ),
    ] = "xlsx",
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Folder for the files [default: DIR]."),
    ] = None,
    verbosity: Verbosity = 0,
) -> ExitCode:
    """Write a finished run or sweep in more formats. Prints the names of the files.

    The page draws the stops whose recordings are in the folder; 'run --record all' keeps all of them.
    """
    folder = runs.run_folder(run)
    is_sweep = (folder / reports.SWEEP_RESULTS).is_file()
    accepted = reports.sweep_format_names() if is_sweep else reports.format_names()
    names = report_formats(formats, "--format", accepted)
    write = _write_sweep if is_sweep else _write_run
    for path in write(folder, folder if output is None else output, names):
        data(str(path))
    return ExitCode.MET


def _write_run(folder: Path, place: Path, names: Sequence[str]) -> list[Path]:
    if runs.holds_sweep(folder):
        raise InvalidInputError(
            f"uictest: {folder} holds a sweep that is not finished: run its command again, "
            "or merge its shards with --merge"
        )
    if reason := runs.why_no_run(folder):
        raise InvalidInputError(f"uictest: {reason}; report takes the folder of a finished run or sweep")
    with _read_as("run", folder, OSError, ValueError):
        content = reports.read_run(folder, traces=reports.draws_stops(names))
    place.mkdir(parents=True, exist_ok=True)
    return reports.write_formats(place, content, names)


def _write_sweep(folder: Path, place: Path, names: Sequence[str]) -> list[Path]:
    with _read_as("sweep", folder, OSError, ValueError):
        content = reports.read_sweep(folder, traces=reports.draws_stops(names))
    place.mkdir(parents=True, exist_ok=True)
    # The cases are read while the workbook is written.
    with _read_as("sweep", folder, ValueError):
        return reports.write_sweep_formats(place, content, names)


@contextlib.contextmanager
def _read_as(kind: str, folder: Path, *errors: type[Exception]) -> Iterator[None]:
    try:
        yield
    except errors as error:
        raise InvalidInputError(f"uictest: {folder} cannot be read as a {kind}: {error}") from error
