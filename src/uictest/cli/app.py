"""The program and its commands."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Annotated, Any, Final, TypeVar

import typer
from typer.core import TyperGroup

from uictest import __version__
from uictest.cli.output import ExitCode, data

Function = TypeVar("Function", bound=Callable[..., Any])


def command(group: typer.Typer, name: str) -> Callable[[Function], Function]:
    """Return the decorator that makes a function a command of a group."""

    def add(function: Function) -> Function:
        return group.command(name, short_help=first_sentence(function.__doc__ or ""))(function)

    return add


def first_sentence(text: str) -> str:
    """Return the first sentence of a help text on one line; typer would cut it at the end of a line."""
    words = text.split()
    end = next((place for place, word in enumerate(words, start=1) if word.endswith(".")), len(words))
    return " ".join(words[:end])


_EPILOG = (
    "Exit codes: 0 every case met its expectation, 1 at least one did not, 2 interrupted, "
    "3 simulation or internal error, 4 usage or invalid file, 5 nothing selected."
)
_SECTIONS: Final = {
    "Run and judge": ("run", "sweep", "check", "list", "compare"),
    "Your WSP": ("init", "controller"),
    "Recorded stops": ("evaluate", "validate", "fit", "export"),
    "Caliper laboratory": ("bench", "identify"),
    "Files and tools": ("report", "open", "library", "schema", "export-rig", "selftest"),
}
"""Heading in `--help` -> the commands below it."""
_NAMES: Final = tuple(name for names in _SECTIONS.values() for name in names)
_FUNCTIONS: Final = {"list": "list_cases", "open": "open_page"}
"""Command -> its function in the module of the command, where that is called otherwise."""
_GROUPS: Final = ("identify", "library", "controller")
"""Names of commands with commands of their own; each is a `Typer` in the module of this name."""


class _Program(TyperGroup):
    """The program, whose help lists its commands in sections."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        limit = formatter.width - 6 - max(map(len, self.commands))
        for heading, names in _SECTIONS.items():
            rows = [(name, self.commands[name].get_short_help_str(limit)) for name in names]
            with formatter.section(heading):
                formatter.write_dl(rows, col_max=max(map(len, self.commands)))


def application(first: str | None = None) -> typer.Typer:
    """Return the program with the one command that `first` names, with all if it names none.

    A command brings what it needs, and most need little of what the others need.
    """
    # Plain help instead of rich's: it starts faster, and user text is never read as markup.
    app = typer.Typer(
        name="uictest",
        cls=_Program,
        add_completion=False,
        rich_markup_mode=None,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
        epilog=_EPILOG,
    )
    app.callback(invoke_without_command=True)(_main)
    for name in (first,) if first in _NAMES else _NAMES:
        own = name.replace("-", "_")
        module = import_module(f"uictest.cli.commands.{own}")
        if name not in _GROUPS:
            command(app, name)(getattr(module, _FUNCTIONS.get(name, own)))
        else:
            group = getattr(module, name)
            group.callback(invoke_without_command=True)(_show_help_alone)
            app.add_typer(group, name=name, short_help=group.info.help)
    return app


def _show_help_alone(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        data(context.get_help())
        # Not a success: in a pipeline a missing command must not look like a passed test.
        raise typer.Exit(ExitCode.USAGE)


def _show_version(requested: bool) -> None:
    if requested:
        data(f"uictest {__version__}")
        raise typer.Exit


def _main(
    context: typer.Context,
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and exit."),
    ] = False,
) -> None:
    """Batch test runner for a simulated railway brake rig: scenarios in, verdicts and reports out."""
    _show_help_alone(context)
