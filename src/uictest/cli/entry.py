"""From arguments to exit code: the one place where errors become messages and exit codes."""

from __future__ import annotations

import errno
import os
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import typer

from uictest import runs
from uictest.cli.app import application
from uictest.cli.options import TRUSTED_FOLDERS, CommandLine
from uictest.cli.output import ExitCode, lost_data, message, use_safe_encoding
from uictest.plans import scenario

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
    "--trust": (("fit", "bench", "export-rig", "identify", "library"), f"{TRUSTED_FOLDERS}=DIR uictest ..."),
    "--color": (("run", "evaluate"), "NO_COLOR=1 uictest ... or FORCE_COLOR=1 uictest ..."),
    "--list": (("bench",), "uictest library list"),
    "--date": (("identify",), "SOURCE_DATE_EPOCH=SECONDS uictest ..."),
    "--seed": (("bench", "export-rig"), "--set seed=N"),
    "-k": (("export-rig",), "--case ID"),
    "--output": (("schema",), "> FILE"),
    "-o": (("schema",), "> FILE"),
}
"""Option that some commands do not have -> these commands, and what to write there."""
_OF_PATHS: Final = frozenset(
    {
        *(errno.ENOENT, errno.ENOTDIR, errno.EISDIR, errno.EEXIST, errno.ENAMETOOLONG, errno.ELOOP),
        *(errno.EACCES, errno.EPERM, errno.EROFS),
    }
)
"""Errors that say that a path cannot be used, and not that the machine fails."""
_DEFAULT_OUTPUT: Final = "reports"
"""Where a command writes if it is not told."""


def execute(arguments: Sequence[str]) -> ExitCode:
    """Run one command line, and return its exit code. Raises nothing."""
    use_safe_encoding()
    code = _outcome(CommandLine(arguments))
    reason = lost_data()
    if reason:
        message(f"uictest: {reason}; data are lost")
    return ExitCode.ERROR if reason and code is not ExitCode.INTERRUPTED else code


def _outcome(invocation: CommandLine) -> ExitCode:
    try:
        return _call(invocation)
    except typer.TyperException as error:
        option = getattr(error, "option_name", "")
        message(f"uictest: {error.format_message()}\n{_advice(invocation.arguments, option)}")
        return ExitCode.USAGE
    except scenario.ScenarioErrors as error:
        for trace in error.traces:
            message(trace)
        message(str(error))
        return ExitCode.ERROR if error.traces else ExitCode.USAGE
    except runs.InvalidInputError as error:
        for text in error.messages:
            message(f"uictest: {text}{_options(error.arguments)}")
        return ExitCode.USAGE
    except KeyboardInterrupt:
        message("uictest: interrupted")
        return ExitCode.INTERRUPTED
    except SystemExit:
        # Outside its standalone mode typer exits only if the reader of `--help` has gone.
        return ExitCode.MET
    except Exception as error:
        reason = _reason(error) if isinstance(error, OSError) else ""
        if _is_of_argument(error, invocation.arguments):
            message(f"uictest: {reason or error}")
            return ExitCode.USAGE
        if not reason:
            message(traceback.format_exc().rstrip())
        message(f"uictest: {reason or f'internal error: {type(error).__name__}: {error}'}")
        return ExitCode.ERROR


def _advice(arguments: Sequence[str], option: str) -> str:
    command = next(iter(arguments), "")
    commands, otherwise = _WRITTEN_OTHERWISE.get(option, ((), ""))
    if command in commands:
        return f"In place of {option} write: {otherwise}"
    if command == "reproduce":
        return "The studies are run by './reproduce' in a checkout of uictest."
    return "Try 'uictest --help', or 'uictest COMMAND --help'."


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
    place = Path(os.path.abspath(os.fsdecode(error.filename)))  # noqa: PTH100 - links stay
    for named in (Path(os.path.abspath(text)) for text in (*texts, _DEFAULT_OUTPUT) if "\0" not in text):  # noqa: PTH100
        if named.is_relative_to(place) or place.parent == named.parent:
            return True
        if error.errno != errno.ENOENT and place.is_relative_to(named):
            return True
    return False


def _options(arguments: Sequence[str]) -> str:
    """Return the options that set some arguments in parentheses; nothing for none."""
    return f" ({', '.join(_OPTIONS[name] for name in arguments)})" if arguments else ""


def _call(invocation: CommandLine) -> ExitCode:
    app = application(next(iter(invocation.arguments), None))
    code = app(args=list(invocation.arguments), prog_name="uictest", standalone_mode=False, obj=invocation)
    if code == _TYPER_INTERRUPTED:
        # Outside its standalone mode typer returns this code for an interrupt.
        raise KeyboardInterrupt
    return ExitCode(code or 0)


def _reason(error: OSError) -> str:
    reason = error.strerror or str(error) or type(error).__name__
    return f"{error.filename}: {reason}" if error.filename is not None else reason
