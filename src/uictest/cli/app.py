"""The program and its commands."""

from __future__ import annotations

from typing import Annotated

import typer

from uictest import __version__
from uictest.cli.commands.bench import bench
from uictest.cli.commands.check import check
from uictest.cli.commands.compare import compare
from uictest.cli.commands.controller import controller
from uictest.cli.commands.evaluate import evaluate
from uictest.cli.commands.export import export
from uictest.cli.commands.export_rig import export_rig
from uictest.cli.commands.fit import fit
from uictest.cli.commands.identify import identify
from uictest.cli.commands.init import init
from uictest.cli.commands.library import library
from uictest.cli.commands.list import list_cases
from uictest.cli.commands.open import open_page
from uictest.cli.commands.report import report
from uictest.cli.commands.reproduce import reproduce
from uictest.cli.commands.run import run
from uictest.cli.commands.schema import schema
from uictest.cli.commands.selftest import selftest
from uictest.cli.commands.sweep import sweep
from uictest.cli.commands.validate import validate
from uictest.cli.exit_codes import ExitCode
from uictest.cli.output import data
from uictest.cli.registration import command

_EPILOG = (
    "Exit codes: 0 every case met its expectation, 1 at least one did not, 2 interrupted, "
    "3 simulation or internal error, 4 usage or invalid file, 5 nothing selected."
)

# Plain help instead of rich's: it starts faster, and user text is never read as markup.
app = typer.Typer(
    name="uictest",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=_EPILOG,
)

for _name, _function in (
    ("run", run),
    ("sweep", sweep),
    ("check", check),
    ("list", list_cases),
    ("evaluate", evaluate),
    ("export", export),
    ("export-rig", export_rig),
    ("fit", fit),
    ("bench", bench),
    ("reproduce", reproduce),
    ("report", report),
    ("open", open_page),
    ("compare", compare),
    ("schema", schema),
    ("init", init),
    ("selftest", selftest),
    ("validate", validate),
):
    command(app, _name)(_function)


def _show_help_alone(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        data(context.get_help())
        # Not a success: in a pipeline a missing command must not look like a passed test.
        raise typer.Exit(ExitCode.USAGE)


for _name, _group in (("identify", identify), ("library", library), ("controller", controller)):
    _group.callback(invoke_without_command=True)(_show_help_alone)
    app.add_typer(_group, name=_name, short_help=_group.info.help)


def _show_version(requested: bool) -> None:
    if requested:
        data(f"uictest {__version__}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def main(
    context: typer.Context,
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and exit."),
    ] = False,
) -> None:
    """Batch test runner for a simulated railway brake rig: scenarios in, verdicts and reports out."""
    _show_help_alone(context)
