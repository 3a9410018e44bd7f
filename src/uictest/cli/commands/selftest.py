"""`uictest selftest`: known answers on this machine; and how the findings of checks are shown."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

from uictest import report, selftest as known_answers
from uictest.cli import options
from uictest.cli.output import ExitCode, data, output_width
from uictest.core import files

_CODES: Final = {"fail": ExitCode.MISSED, "error": ExitCode.ERROR}
"""Worst finding -> exit code; any other is `ExitCode.MET`."""


def selftest(
    junit: options.JUnitFile = None, shown: options.ListFormat = options.PlainFormat.TEXT
) -> ExitCode:
    """Check that this installation gives known answers: stored bits, closed forms, verdicts, controllers.

    Exit code 1: an answer differs; 3: a check failed to run. What this machine cannot check is listed.
    """
    file = options.junit_file(junit, Path())
    return show_findings(known_answers.examine(known_answers.KnownStops()), shown, file)


def show_findings(
    examination: known_answers.Examination, shown: options.PlainFormat, junit: Path | None
) -> ExitCode:
    """Print the findings, write them as JUnit where a file is asked for, and return what they come to."""
    if shown is options.PlainFormat.JSON:
        data(known_answers.findings_json(examination))
    else:
        document = known_answers.finding_document(examination)
        data("\n".join(report.document_lines(document, output_width(sys.stdout))))
    if junit is not None:
        files.write_to(junit, report.junit_text([known_answers.findings_suite(examination)]))
    return _CODES.get(examination.status, ExitCode.MET)
