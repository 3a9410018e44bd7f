"""`uictest validate`: recorded stops against their simulation."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from uictest import report, runs
from uictest.analysis import validation
from uictest.cli import options
from uictest.cli.options import argument, option
from uictest.cli.output import ExitCode, data, message, output_width, worst
from uictest.cli.run_display import TerminalObserver

Files = Annotated[
    list[Path],
    argument("FILE", "Validation files (.yaml), or series that name recordings.", show_default=False),
]
Output = Annotated[Path, option("-o --output DIR", "Folder for validations; each gets a folder in it.")]


def validate(
    context: typer.Context,
    files: Files,
    overrides: options.Overrides = None,
    trusted: options.Trusted = None,
    jobs: options.Jobs = "auto",  # type: ignore[assignment]  # typer hands the text to the option's parser
    output: Output = Path("reports"),
    shown: options.ListFormat = options.PlainFormat.TEXT,
    verbose: options.Verbose = False,
) -> ExitCode:
    """Compare recorded stops with their simulation: bias and spread of every figure, and the domain.

    Writes validation.json, which `uictest run --validated` reads, a summary, and a table of figures and
    stops. Exit code 1: a recorded stop cannot be counted; 3: a simulation failed.
    """
    plans = runs.load_validations(files, overrides, trusted)
    if shown is options.PlainFormat.JSON and len(plans) > 1:
        raise typer.BadParameter(
            f"prints the document of one validation, found {', '.join(plan.name for plan in plans)}",
            param_hint="--format json",
        )
    codes = [ExitCode.MET]
    for plan in plans:
        run = runs.run_validation(plan, jobs, trusted, TerminalObserver())
        place = runs.publish_validation(run, context.obj, output)
        _show(run.validation, shown, every_figure=verbose)
        message(f"uictest: {plan.name}: {validation.tally(run.validation)}; validation in {place}")
        codes.append(_code(run))
    return worst(*codes)


def _show(validated: validation.Validation, shown: options.PlainFormat, *, every_figure: bool) -> None:
    if shown is options.PlainFormat.JSON:
        data(validation.validation_json(validated).rstrip("\n"))
        return
    document = validation.validation_document(validated, every_figure=every_figure)
    data("\n".join(report.document_lines(document, output_width(sys.stdout))))


def _code(run: runs.ValidationRun) -> ExitCode:
    if not run.complete:
        return ExitCode.ERROR
    return ExitCode.MISSED if run.validation.not_usable else ExitCode.MET
