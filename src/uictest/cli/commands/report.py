"""`uictest report`: write a finished run or sweep in more formats."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated

import typer

from uictest import report as reports, runs
from uictest.cli.cases import malformed
from uictest.cli.options import Draw, argument, option, report_formats
from uictest.cli.output import ExitCode, data
from uictest.core import files


def report(
    run: Annotated[Path, argument("DIR", "Folder of a finished run or sweep, e.g. reports/latest.")],
    formats: Annotated[
        str, option("--format FORMATS", f"Formats, joined by commas: {', '.join(reports.FORMATS)}.")
    ] = "xlsx",
    draw: Draw = None,
    output: Annotated[Path | None, option("-o --output DIR", "Folder for the files [default: DIR].")] = None,
) -> ExitCode:
    """Write a finished run or sweep in more formats. Prints the names of the files.

    The page draws the stops whose recordings are in the folder; 'run --record all' keeps all of them.
    """
    folder = runs.run_folder(run)
    is_sweep = runs.holds_sweep(folder) and (folder / reports.RESULTS).is_file()
    names = report_formats(formats, "--format", reports.FORMATS)
    if is_sweep and draw is not None:
        raise typer.BadParameter("a sweep draws its worst cases; --draw is for runs", param_hint="--draw")
    target = folder if output is None else output
    written = _write_sweep(folder, target, names) if is_sweep else _write_run(folder, target, names, draw)
    for path in written:
        data(str(path))
    return ExitCode.MET


def _write_run(folder: Path, target: Path, names: Sequence[str], draw: str | None) -> list[Path]:
    if runs.holds_sweep(folder):
        raise runs.InvalidInputError(
            f"{folder} holds a sweep that is not finished: run its command again, "
            "or merge its shards with --merge"
        )
    if reason := runs.why_no_run(folder):
        raise runs.InvalidInputError(f"{reason}; report takes the folder of a finished run or sweep")
    with _read_as("run", folder, OSError, ValueError):
        content = reports.read_run(folder)
        chosen = _drawn_first(content, draw)
        if not reports.DRAWING.isdisjoint(names):
            content = reports.with_recorded_traces(content, folder, chosen)
    files.make_folder(target)
    return reports.publish(reports.publication_of_run(content), names, target)


def _drawn_first(content: reports.RunContent, expression: str | None) -> frozenset[str]:
    """Return the ids of the cases that `--draw` chooses. Raises typer.BadParameter if it chooses none."""
    if expression is None:
        return frozenset()
    with malformed("--draw", expression):
        chosen = runs.result_ids(content, expression)
    if not chosen:
        raise typer.BadParameter(f"no case of the run matches {expression!r}", param_hint="--draw")
    return chosen


def _write_sweep(folder: Path, target: Path, names: Sequence[str]) -> list[Path]:
    with _read_as("sweep", folder, OSError, ValueError):
        content = reports.read_sweep(folder, traces=not reports.DRAWING.isdisjoint(names))
    files.make_folder(target)
    # The cases are read while the workbook is written.
    with _read_as("sweep", folder, ValueError):
        return reports.publish(reports.publication_of_sweep(content), names, target)


@contextlib.contextmanager
def _read_as(kind: str, folder: Path, *errors: type[Exception]) -> Iterator[None]:
    try:
        yield
    except errors as error:
        raise runs.InvalidInputError(f"{folder} cannot be read as a {kind}: {error}") from error
