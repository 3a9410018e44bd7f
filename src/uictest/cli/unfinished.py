"""The JUnit file of a command that ends without results: a CI server must not read an older one."""

from __future__ import annotations

import os
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple, TypeAlias

from uictest import report
from uictest.cli.options import JUNIT, is_replaceable
from uictest.cli.output import ExitCode, message
from uictest.core import files
from uictest.plans import scenario

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
        self._before = self._path and _identity(self._path)
        self._command = f"uictest {next(iter(arguments), '')}"

    def write(self, ending: Ending) -> None:
        """Write why a command ended, unless it has written the file, or ended because of it."""
        path, code = self._path, ending.code
        if path is None or ending.about in (JUNIT, str(path)) or code is ExitCode.MET:
            return
        reasons = ending.reasons or [f"exit code {code:d}: {code.name.lower().replace('_', ' ')}"]
        try:
            if _identity(path) == self._before and is_replaceable(path):
                files.make_folder(path.parent)  # that of -o, which nothing has made yet
                files.write_to(path, _document(reasons, self._command))
        except (OSError, ValueError) as error:
            message(f"uictest: {error}")


def _identity(path: Path) -> tuple[int, int] | None:
    try:
        found = os.stat(path)  # noqa: PTH116 - a name may be too long, or hold a null
    except (OSError, ValueError):
        return None
    return found.st_ino, found.st_mtime_ns


def _document(reasons: Sequence[Reason], command: str) -> str:
    """Return a JUnit document with a testcase for each file with errors, and one for all else."""
    from uictest.core.document import Suite, Testcase, class_name  # which few commands need

    lines: dict[str, list[str]] = {}
    for each in reasons:
        lines.setdefault("" if isinstance(each, str) else each.file, []).extend(str(each).splitlines())
    testcases = [
        Testcase(class_name(file) if Path(file).name else "uictest", file or command, "error", texts)
        for file, texts in lines.items()
    ]
    return report.junit_text([Suite("uictest", testcases)])
