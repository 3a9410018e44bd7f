"""`uictest selftest`: known answers on this machine."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

from uictest import selftest as known_answers
from uictest.cli import options
from uictest.cli.exit_codes import ExitCode
from uictest.cli.output import data, terminal_width
from uictest.cli.progress import compilation_shown
from uictest.core import files

_CODES: Final = {"fail": ExitCode.MISSED, "error": ExitCode.ERROR}
"""Worst finding -> exit code; any other is `ExitCode.MET`."""


def selftest(
    junit: options.JUnitFile = None,
    shown: options.ListFormat = options.PlainFormat.TEXT,
    verbosity: options.Verbosity = 0,
) -> ExitCode:
    """Check that this installation gives known answers: stored bits, closed forms, verdicts, controllers.

    Exit code 1: an answer differs; 3: a check failed to run. What this machine cannot check is listed.
    """
    file = options.junit_file(junit, Path())
    stops = known_answers.KnownStops()
    with compilation_shown():
        examination = known_answers.examine(stops)
    if shown is options.PlainFormat.JSON:
        data(known_answers.findings_json(examination))
    else:
        data("\n".join(known_answers.finding_table(examination, terminal_width(sys.stdout))))
    if file is not None:
        files.write_to(file, known_answers.junit_xml(examination))
    return _CODES.get(examination.status, ExitCode.MET)
