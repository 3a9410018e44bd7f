"""What checks of an installation or a controller have found, on the streams and in a file."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

from uictest import report, selftest
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import PlainFormat
from uictest.cli.output import data, terminal_width
from uictest.core import files

_CODES: Final = {"fail": ExitCode.MISSED, "error": ExitCode.ERROR}
"""Worst finding -> exit code; any other is `ExitCode.MET`."""


def show_findings(examination: selftest.Examination, shown: PlainFormat, junit: Path | None) -> ExitCode:
    """Print the findings, write them as JUnit where a file is asked for, and return what they come to."""
    if shown is PlainFormat.JSON:
        data(selftest.findings_json(examination))
    else:
        document = selftest.finding_document(examination)
        data("\n".join(report.document_lines(document, terminal_width(sys.stdout))))
    if junit is not None:
        files.write_to(junit, report.junit_text([selftest.findings_suite(examination)]))
    return _CODES.get(examination.status, ExitCode.MET)
