"""`uictest reproduce`: run the studies and show the paper's values next to ours."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from uictest import report, runs, studies
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import Colour, Colouring, Jobs, ListFormat, PlainFormat, Verbosity
from uictest.cli.output import coloured, data, interactive, message
from uictest.cli.progress import compilation_shown
from uictest.plans.scenario import yaml

_INSTALL_FIGURES = "pip install 'uictest[figures]'"


def reproduce(
    context: typer.Context,
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[STUDY]...", help="Names of studies [default: all].", show_default=False),
    ] = None,
    listed: Annotated[bool, typer.Option("--list", help="List the studies and run none.")] = False,
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder for pages, data and figures.")
    ] = Path("reports", "studies"),
    shown: ListFormat = PlainFormat.TEXT,
    jobs: Jobs = "auto",  # type: ignore[assignment]  # typer hands the text to the option's parser
    quiet: Annotated[
        bool, typer.Option("-q", "--quiet", help="Show only the values that miss their band.")
    ] = False,
    verbosity: Verbosity = 0,
    colour: Colouring = Colour.AUTO,
) -> ExitCode:
    """Run the studies of the paper and print its values next to ours. Writes a page for each.

    Each value has a status (calibrated, selected, by construction, predicted) and a result (holds, misses,
    shown). Exit 1 if a value misses its band, unless that is the paper's and declared missed; 1 too if a
    declared miss holds.
    """
    selected = _selected(names or ())
    if listed:
        _list(selected, shown)
        return ExitCode.MET
    results = _run(selected, jobs, output, quiet=quiet)
    _write_pages(results, output, context.obj.arguments)
    if shown is PlainFormat.JSON:
        data(studies.document(results))
    else:
        _show(results, colour, quiet=quiet)
    failed = [each.study.name for each in results if each.fails]
    if not quiet:
        amiss = f"; not as claimed: {', '.join(failed)}" if failed else ""
        counted = report.counted(len(results), "study", "studies")
        message(f"uictest: {counted}, {studies.tally(results)}{amiss}; in {output}")
    return ExitCode.MISSED if failed else ExitCode.MET


def _selected(names: Sequence[str]) -> list[studies.Study]:
    """Return the studies of these names in the order of the catalogue; all where there is no name."""
    for name in names:
        if name not in studies.STUDIES:
            hint = yaml.suggestion(name, studies.STUDIES)
            raise runs.InvalidInputError(f"no study {name!r}; {hint}")
    return [study for name, study in studies.STUDIES.items() if not names or name in names]


def _list(selected: Sequence[studies.Study], shown: PlainFormat) -> None:
    if shown is PlainFormat.JSON:
        data(json.dumps([{"name": study.name, "title": study.title} for study in selected], indent=2))
        return
    width = max(len(study.name) for study in selected)
    data("\n".join(f"{study.name.ljust(width)}  {study.title}" for study in selected))


def _run(
    selected: Sequence[studies.Study], jobs: int, output: Path, *, quiet: bool
) -> list[studies.StudyResult]:
    """Run the studies one after the other, and write the tables of each as soon as it has ended."""
    stop_runner = studies.StopRunner(jobs)
    results: list[studies.StudyResult] = []
    for study in selected:
        if not quiet:
            message(f"uictest: {study.name}...")
        with compilation_shown(quiet=quiet):
            results.append(studies.run_study(study, stop_runner))
        studies.write_tables(output, results[-1])
    studies.write_comparison(output, results)
    return results


def _write_pages(results: Sequence[studies.StudyResult], output: Path, arguments: Sequence[str]) -> None:
    """Draw the figures and write the pages that hold them."""
    drawn, known = _draw(results, output), list(studies.STUDIES.values())
    for problem in studies.write_pages(output, results, known, arguments, drawn):
        message(f"uictest: {problem}")


def _draw(results: Sequence[studies.StudyResult], output: Path) -> list[Path]:
    """Draw the figures, and return their files; without matplotlib there are none."""
    try:
        return [path for result in results for path in studies.write_figures(output, result)]
    except ImportError as error:
        message(f"uictest: no figures: {error.name or 'matplotlib'} is not installed ({_INSTALL_FIGURES})")
        return []


def _show(results: Sequence[studies.StudyResult], colour: Colour, *, quiet: bool) -> None:
    if quiet:
        data("\n".join([*studies.misses(results), *studies.claims(results)]))
        return
    if not interactive(sys.stdout):
        for each in results:
            data("\n".join(studies.lines(each)))
    else:
        from rich.console import Console

        in_colour = coloured(colour, sys.stdout)
        console = Console(
            color_system="auto" if in_colour else None, force_terminal=in_colour, highlight=False
        )
        for each in results:
            console.print(studies.study_table(each))
    if len(results) > 1:
        data("\n".join(studies.claims(results)))
