"""`uictest selftest`: known answers on this machine; and how the findings of checks are shown."""

from __future__ import annotations

import sys
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Final

import typer

from uictest import report, runs, selftest as known_answers
from uictest.cli import options
from uictest.cli.commands.schema import SchemaKind, schema_text
from uictest.cli.output import ExitCode, data, terminal_width
from uictest.cli.progress import compilation_shown
from uictest.core import files
from uictest.selftest import dossier as assessor

_CODES: Final = {"fail": ExitCode.MISSED, "error": ExitCode.ERROR}
"""Worst finding -> exit code; any other is `ExitCode.MET`."""


def selftest(
    junit: options.JUnitFile = None,
    shown: options.ListFormat = options.PlainFormat.TEXT,
    dossier: Annotated[
        Path | None, options.option("--dossier FILE", "Also write an archive for an assessor (zip) to FILE.")
    ] = None,
    tests: Annotated[
        Path | None,
        options.option("--tests FILE", "JUnit file of a run of ./test, for the archive of --dossier."),
    ] = None,
) -> ExitCode:
    """Check that this installation gives known answers: stored bits, closed forms, verdicts, controllers.

    Exit code 1: an answer differs; 3: a check failed to run. What this machine cannot check is listed.
    """
    file, archive = options.junit_file(junit, Path()), options.junit_file(dossier, Path(), "--dossier")
    if tests is not None and archive is None:
        raise typer.BadParameter("goes with --dossier", param_hint="--tests")
    run = None if tests is None else _test_run(tests)
    stops = known_answers.KnownStops()
    with compilation_shown():
        examination = known_answers.examine(stops)
    if archive is not None:
        schemas = {f"{kind.value}.schema.json": schema_text(kind) for kind in SchemaKind}
        contents = assessor.dossier_files(examination, schemas, datetime.now(UTC), run)
        files.write_to(archive, assessor.packed(contents))
    return show_findings(examination, shown, file)


def _test_run(file: Path) -> assessor.TestRun:
    try:
        return assessor.read_test_run(file.read_bytes())
    except (OSError, ValueError) as error:
        raise runs.InvalidInputError(f"{file}: no record of a run of the tests: {error}") from error


def show_findings(
    examination: known_answers.Examination, shown: options.PlainFormat, junit: Path | None
) -> ExitCode:
    """Print the findings, write them as JUnit where a file is asked for, and return what they come to."""
    if shown is options.PlainFormat.JSON:
        data(known_answers.findings_json(examination))
    else:
        document = known_answers.finding_document(examination)
        data("\n".join(report.document_lines(document, terminal_width(sys.stdout))))
    if junit is not None:
        files.write_to(junit, report.junit_text([known_answers.findings_suite(examination)]))
    return _CODES.get(examination.status, ExitCode.MET)
