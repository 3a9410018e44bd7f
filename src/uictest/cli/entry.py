"""From arguments to a command and to an exit code: the one place where errors become messages."""

from __future__ import annotations

import errno
import os
import re
import traceback
from collections.abc import Callable, Sequence
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Final, NamedTuple, TypeAlias, TypeVar

import typer
from typer.core import TyperGroup

from uictest import __version__, report, runs
from uictest.cli.options import JUNIT, TRUSTED_FOLDERS, is_replaceable, option
from uictest.cli.output import ExitCode, data, lost_data, message, use_safe_encoding
from uictest.core import files
from uictest.plans import scenario
from uictest.plans.scenario import yaml

Function = TypeVar("Function", bound=Callable[..., Any])


def command(group: typer.Typer, name: str) -> Callable[[Function], Function]:
    """Return the decorator that makes a function a command of a group."""

    def add(function: Function) -> Function:
        return group.command(name, short_help=first_sentence(function.__doc__ or ""))(function)

    return add


def first_sentence(text: str) -> str:
    """Return the first sentence of a help text on one line; typer would cut it at the end of a line."""
    words = text.split()
    end = next((count for count, word in enumerate(words, start=1) if word.endswith(".")), len(words))
    return " ".join(words[:end])


_EPILOG = (
    "Exit codes: 0 every case met its expectation, 1 at least one did not, 2 interrupted, "
    "3 simulation, write or internal error, 4 usage or invalid file, 5 nothing selected."
)
_SECTIONS: Final = {
    "Run and judge": ("run", "sweep", "search", "check", "list", "compare"),
    "Your WSP": ("init", "controller", "export-controller"),
    "Recorded stops": ("evaluate", "log", "validate", "fit", "export"),
    "Caliper laboratory": ("bench", "identify"),
    "Files and tools": ("report", "open", "library", "schema", "export-rig", "selftest"),
}
"""Heading in `--help` -> the commands below it."""
_NAMES: Final = tuple(name for names in _SECTIONS.values() for name in names)
_MODULES: Final = {"export-rig": "export_fmu", "export-controller": "export_fmu"}
"""Command -> its module, where that is called otherwise."""
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
        function = name.replace("-", "_")
        module = import_module(f"uictest.cli.commands.{_MODULES.get(name, function)}")
        if name not in _GROUPS:
            command(app, name)(getattr(module, _FUNCTIONS.get(name, function)))
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
        bool, option("--version", "Show the version and exit.", callback=_show_version, is_eager=True)
    ] = False,
) -> None:
    """Batch test runner for a simulated railway brake rig: scenarios in, verdicts and reports out."""
    _show_help_alone(context)


_TYPER_INTERRUPTED = 130
_OPTIONS: Final = {"restart": "--restart", "output": "-o", "cluster": "--dask"}
"""Argument that an error names -> the option that sets it."""
_WRITTEN_OTHERWISE: Final = {
    "--rail": (("evaluate",), "--set rail.condition=NAME"),
    "--position": (("evaluate",), "--set brake.position=NAME"),
    "--wsp": (("evaluate",), "--set rig.wsp=STATE"),
    "--criteria": (("evaluate",), "--set criteria=NAME"),
    "--trigger-lead": (("evaluate", "fit"), "preparation: {trigger_lead: TIME} in the file of --map"),
    "--raster": (("evaluate", "fit"), "preparation: {raster: TIME} in the file of --map"),
    "--low-pass": (("evaluate", "fit"), "preparation: {low_pass: FREQUENCY} in the file of --map"),
    "--trust": (
        ("fit", "bench", "export-rig", "export-controller", "identify", "library"),
        f"{TRUSTED_FOLDERS}=DIR uictest ...",
    ),
    "--color": (("run", "evaluate"), "NO_COLOR=1 uictest ... or FORCE_COLOR=1 uictest ..."),
    "--list": (("bench",), "uictest library list"),
    "--date": (("identify",), "SOURCE_DATE_EPOCH=SECONDS uictest ..."),
    "--seed": (("bench", "export-rig"), "--set seed=N"),
    "-k": (("export-rig",), "--case ID"),
    "--cleaning": (("fit",), "known numbers under rail.cleaning in the file of --scenario"),
    "--output": (("schema",), "> FILE"),
    "-o": (("schema",), "> FILE"),
}
"""Option that some commands do not have -> these commands, and what to write there."""
_OF_PATHS: Final = frozenset(
    {errno.ENOENT, errno.ENOTDIR, errno.EISDIR, errno.ENAMETOOLONG, errno.ELOOP, errno.EACCES, errno.EPERM}
)
"""Errors that say that a path cannot be read, and not that the machine fails."""


def execute(arguments: Sequence[str]) -> ExitCode:
    """Run one command line, and return its exit code. Raises nothing."""
    use_safe_encoding()
    junit = UnfinishedJUnit(arguments)
    ending = _ending_of_command(tuple(arguments))
    junit.write(ending)
    reason = lost_data()
    if reason:
        message(f"uictest: {reason}; data are lost")
    return ExitCode.ERROR if reason and ending.code is not ExitCode.INTERRUPTED else ending.code


def _ending_of_command(arguments: tuple[str, ...]) -> Ending:
    """Run one command line, and say why an exception ended it."""
    try:
        return Ending(_call(arguments))
    except typer.TyperException as error:
        option = getattr(error, "option_name", "")
        reason = _usage_reason(error)
        message(f"uictest: {reason}\n{_option_advice(arguments, option)}")
        return Ending(ExitCode.USAGE, [reason], option)
    except scenario.ScenarioErrors as error:
        for trace in error.traces:
            message(trace)
        message(str(error))
        return Ending(ExitCode.ERROR if error.traces else ExitCode.USAGE, error.diagnostics)
    except runs.InvalidInputError as error:
        options = f" ({', '.join(_OPTIONS[name] for name in error.arguments)})" if error.arguments else ""
        texts = [f"{text}{options}" for text in error.messages]
        message("\n".join(f"uictest: {text}" for text in texts))
        return Ending(ExitCode.USAGE, texts)
    except files.WriteError as error:
        message(f"uictest: {error}")
        return Ending(ExitCode.ERROR, [str(error)], error.filename)
    except KeyboardInterrupt:
        message("uictest: interrupted")
        return Ending(ExitCode.INTERRUPTED)
    except SystemExit:
        # Outside its standalone mode typer exits only if the reader of `--help` has gone.
        return Ending(ExitCode.MET)
    except Exception as error:
        reason = _error_reason(error) if isinstance(error, OSError) else ""
        if _is_of_argument(error, arguments):
            message(f"uictest: {reason or error}")
            return Ending(ExitCode.USAGE, [reason or str(error)])
        if not reason:
            message(traceback.format_exc().rstrip())
            reason = f"internal error: {type(error).__name__}: {error}"
        message(f"uictest: {reason}")
        return Ending(ExitCode.ERROR, [reason])


def _option_advice(arguments: Sequence[str], option: str) -> str:
    command = next(iter(arguments), "")
    commands, otherwise = _WRITTEN_OTHERWISE.get(option, ((), ""))
    if command in commands:
        return f"In place of {option} write: {otherwise}"
    if command == "reproduce":
        return "The studies are run by './reproduce' in a checkout of uictest."
    return f"Try 'uictest {f'{command} ' if command in _NAMES else ''}--help'."


_REASONS: Final = {
    "int_parsing": "is not a whole number",
    "float_parsing": "is not a number",
    "greater_than_equal": "is too small: at least {ge}",
    "less_than_equal": "is too large: at most {le}",
    "finite_number": "is not a finite number",
}
"""Kind of error in the value of an option -> what is wrong with the value."""


def _usage_reason(error: typer.TyperException) -> str:
    """Return why arguments are refused; of a value that was validated: the value, and what is accepted."""
    from pydantic import ValidationError  # which --help does not need

    text, cause = error.format_message(), error.__cause__
    if not isinstance(cause, ValidationError):
        return text
    [first, *_] = cause.errors(include_url=False)
    reason = _REASONS.get(first["type"])
    if reason is not None:
        reason = f"{first['input']!r} {reason.format(**first.get('ctx', {}))}"
    else:
        reason = first["msg"].removeprefix("Value error, ").rstrip(".")
        guess = yaml.nearest(str(first["input"]), re.findall(r"'([^']+)'", reason)[1:])
        reason += f"; did you mean {guess!r}?" if guess else ""
    return text.replace(first["msg"], reason)


def _is_of_argument(error: Exception, arguments: Sequence[str]) -> bool:
    """Return whether an argument is a path that cannot be: too long, through a file, below nothing."""
    texts = [text.partition("=")[2] if text.startswith("--") and "=" in text else text for text in arguments]
    if isinstance(error, RuntimeError):  # Python 3.11 and 3.12 raise no OSError for links in a circle
        return str(error).startswith("Symlink loop")
    if isinstance(error, UnicodeEncodeError):
        return any(not text.isascii() and error.object[error.start] in text for text in texts)
    if isinstance(error, ValueError):
        return any("\0" in text for text in texts) or ("" in texts and "an empty name" in str(error))
    if not isinstance(error, OSError) or error.errno not in _OF_PATHS or not error.filename:
        return False
    failed = Path(os.path.abspath(os.fsdecode(error.filename)))  # noqa: PTH100 - links stay
    named = (Path(os.path.abspath(text)) for text in texts if "\0" not in text)  # noqa: PTH100
    inside = error.errno != errno.ENOENT
    return any(path.is_relative_to(failed) or (inside and failed.is_relative_to(path)) for path in named)


def _call(arguments: tuple[str, ...]) -> ExitCode:
    app = application(next(iter(arguments), None))
    code = app(args=list(arguments), prog_name="uictest", standalone_mode=False, obj=arguments)
    if code == _TYPER_INTERRUPTED:
        # Outside its standalone mode typer returns this code for an interrupt.
        raise KeyboardInterrupt
    return ExitCode(code or 0)


def _error_reason(error: OSError) -> str:
    reason = error.strerror or str(error) or type(error).__name__
    return f"{error.filename}: {reason}" if error.filename is not None else reason


Reason: TypeAlias = "scenario.Diagnostic | str"
"""Why a command ended: an error in a file, or a sentence."""


class Ending(NamedTuple):
    """How a command ended; if by an exception: why, and the option or the file that it was about."""

    code: ExitCode
    reasons: Sequence[Reason] = ()
    about: str | None = None


class UnfinishedJUnit:
    """The file of `--junitxml`, if the command line asks for one."""

    def __init__(self, arguments: Sequence[str]) -> None:
        given = [after for text, after in pairwise(arguments) if text == JUNIT]
        given += [text.partition("=")[2] for text in arguments if text.startswith(f"{JUNIT}=")]
        self._path = Path(given[-1]) if given else None
        self._before = self._path and _file_identity(self._path)
        self._command = f"uictest {next(iter(arguments), '')}"

    def write(self, ending: Ending) -> None:
        """Write why a command ended, unless it has written the file, or ended because of it."""
        path, code = self._path, ending.code
        if path is None or ending.about in (JUNIT, str(path)) or code is ExitCode.MET:
            return
        reasons = ending.reasons or [f"exit code {code:d}: {code.name.lower().replace('_', ' ')}"]
        try:
            if _file_identity(path) == self._before and is_replaceable(path):
                files.make_folder(path.parent)  # that of -o, which nothing has made yet
                files.write_to(path, _junit_document(reasons, self._command))
        except (OSError, ValueError) as error:
            message(f"uictest: {error}")


def _file_identity(path: Path) -> tuple[int, int] | None:
    try:
        status = os.stat(path)  # noqa: PTH116 - a name may be too long, or hold a null
    except (OSError, ValueError):
        return None
    return status.st_ino, status.st_mtime_ns


def _junit_document(reasons: Sequence[Reason], command: str) -> str:
    """Return a JUnit document with a testcase for each file with errors, and one for all else."""
    from uictest.core.document import Suite, Testcase, class_name  # which few commands need

    lines: dict[str, list[str]] = {}
    for reason in reasons:
        lines.setdefault("" if isinstance(reason, str) else reason.file, []).extend(str(reason).splitlines())
    testcases = [
        Testcase(class_name(file) if Path(file).name else "uictest", file or command, "error", texts)
        for file, texts in lines.items()
    ]
    return report.junit_text([Suite("uictest", testcases)])
