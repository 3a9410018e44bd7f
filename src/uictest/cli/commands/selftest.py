"""`uictest selftest`: known answers on this machine."""

from __future__ import annotations

from pathlib import Path

from uictest import selftest as known_answers
from uictest.cli import options
from uictest.cli.exit_codes import ExitCode
from uictest.cli.findings import show_findings
from uictest.cli.progress import compilation_shown


def selftest(
    junit: options.JUnitFile = None,
    shown: options.ListFormat = options.PlainFormat.TEXT,
) -> ExitCode:
    """Check that this installation gives known answers: stored bits, closed forms, verdicts, controllers.

    Exit code 1: an answer differs; 3: a check failed to run. What this machine cannot check is listed.
    """
    file = options.junit_file(junit, Path())
    stops = known_answers.KnownStops()
    with compilation_shown():
        examination = known_answers.examine(stops)
    return show_findings(examination, shown, file)
