"""From arguments to exit code: the one place where errors become messages and exit codes."""

from __future__ import annotations

import traceback
from collections.abc import Sequence
from typing import Final

import typer

from uictest import runs, scenario
from uictest.cli.app import app
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import CommandLine
from uictest.cli.output import lost_data, message, use_safe_encoding

_TYPER_INTERRUPTED = 130
_OPTIONS: Final = {"restart": "--restart", "output": "-o", "cluster": "--dask", "device": "--device"}
"""Argument that an error names -> the option that sets it."""


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
        message(f"uictest: {error.format_message()}\nTry 'uictest --help', or 'uictest COMMAND --help'.")
        return ExitCode.USAGE
    except scenario.ScenarioErrors as error:
        message(str(error))
        return ExitCode.USAGE
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
    except OSError as error:
        return _failed(_reason(error), invocation)
    except Exception as error:
        return _failed(f"internal error: {type(error).__name__}: {error}", invocation)


def _options(arguments: Sequence[str]) -> str:
    """Return the options that set some arguments in parentheses; nothing for none."""
    return f" ({', '.join(_OPTIONS[name] for name in arguments)})" if arguments else ""


def _call(invocation: CommandLine) -> ExitCode:
    code = app(args=list(invocation.arguments), prog_name="uictest", standalone_mode=False, obj=invocation)
    if code == _TYPER_INTERRUPTED:
        # Outside its standalone mode typer returns this code for an interrupt.
        raise KeyboardInterrupt
    return ExitCode(code or 0)


def _failed(reason: str, invocation: CommandLine) -> ExitCode:
    if invocation.verbosity > 0:
        message(traceback.format_exc().rstrip())
        message(f"uictest: {reason}")
    else:
        message(f"uictest: {reason} (-v shows where)")
    return ExitCode.ERROR


def _reason(error: OSError) -> str:
    reason = error.strerror or str(error) or type(error).__name__
    return f"{error.filename}: {reason}" if error.filename is not None else reason
