"""`uictest reproduce`: the studies of the paper, the paper's values next to ours."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from uictest import controllers, rig
from uictest.cli.compilation import announce_compilation
from uictest.cli.display import interactive
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import Colour, Colouring, Jobs, PlainFormat, Quiet, Verbosity
from uictest.cli.problems import InvalidInputError
from uictest.cli.streams import coloured, data, message
from uictest.report import counted
from uictest.scenario import yaml

if TYPE_CHECKING:
    from uictest.studies import Study, StudyResult

_FIGURES = "pip install 'uictest[figures]'"


def reproduce(
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[STUDY]...", help="Names of studies [default: all].", show_default=False),
    ] = None,
    listed: Annotated[bool, typer.Option("--list", help="List the studies and run none.")] = False,
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder for data and figures.")
    ] = Path("reports", "studies"),
    shown: Annotated[
        PlainFormat,
        typer.Option("--format", help="What stdout carries: tables or lines, or a JSON document."),
    ] = PlainFormat.TEXT,
    jobs: Jobs = "auto",  # type: ignore[assignment]  # typer hands the text to the option's parser
    quiet: Quiet = False,
    verbosity: Verbosity = 0,
    colour: Colouring = Colour.AUTO,
) -> ExitCode:
    """Run the studies of the paper and print its values next to ours.

    Exit 0 when every band holds, else 1.
    """
    studies = _selected(names or ())
    if listed:
        _list(studies, shown)
        return ExitCode.MET

    from uictest.studies import document

    results = _run(studies, jobs, output, quiet=quiet)
    if shown is PlainFormat.JSON:
        data(document(results))
    else:
        _show(results, colour, quiet=quiet)
    missed = sum(each.status == "misses" for each in results)
    if not quiet:
        verdict = f"{missed} of them with a value outside its band" if missed else "every band holds"
        message(
            f"uictest: {counted(len(results), 'study').replace('studys', 'studies')}, {verdict}; in {output}"
        )
    return ExitCode.MISSED if missed else ExitCode.MET


def _selected(names: Sequence[str]) -> list[Study]:
    """Return the studies of these names in the order of the catalogue; all where there is no name."""
    from uictest.studies import STUDIES

    for name in names:
        if name not in STUDIES:
            raise InvalidInputError(f"uictest: no study {name!r}; {yaml.suggestion(name, STUDIES)}")
    return [study for name, study in STUDIES.items() if not names or name in names]


def _list(studies: Sequence[Study], shown: PlainFormat) -> None:
    if shown is PlainFormat.JSON:
        import json

        data(json.dumps([{"name": study.name, "title": study.title} for study in studies], indent=2))
        return
    width = max(len(study.name) for study in studies)
    data("\n".join(f"{study.name.ljust(width)}  {study.title}" for study in studies))


def _run(studies: Sequence[Study], jobs: int, output: Path, *, quiet: bool) -> list[StudyResult]:
    """Run the studies one after the other, and write the tables of each as soon as it has ended."""
    from uictest.studies import StopRunner, run_study, write_comparison, write_tables

    announce_compilation(
        warm=rig.stops_are_compiled([controllers.CONTROLLERS[controllers.DEFAULT]]), quiet=quiet
    )
    stop_runner = StopRunner(jobs)
    results: list[StudyResult] = []
    for study in studies:
        if not quiet:
            message(f"uictest: {study.name}...")
        results.append(run_study(study, stop_runner))
        write_tables(output, results[-1])
    write_comparison(output, results)
    _draw(results, output)
    return results


def _draw(results: Sequence[StudyResult], output: Path) -> None:
    from uictest.studies import write_figures

    try:
        for result in results:
            write_figures(output, result)
    except ImportError as error:
        message(
            f"uictest: no figures, since {error.name or 'matplotlib'} is not installed: {_FIGURES} draws them"
        )


def _show(results: Sequence[StudyResult], colour: Colour, *, quiet: bool) -> None:
    shown = [each for each in results if not quiet or each.status == "misses"]
    if not interactive(sys.stdout):
        from uictest.studies import lines

        for each in shown:
            data("\n".join(lines(each)))
        return

    from rich.console import Console

    from uictest.studies import study_table

    in_colour = coloured(colour, sys.stdout)
    console = Console(color_system="auto" if in_colour else None, force_terminal=in_colour, highlight=False)
    for each in shown:
        console.print(study_table(each))
