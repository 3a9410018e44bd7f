"""The variants of one run side by side, for `uictest compare --over`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from uictest import report, runs
from uictest.analysis import comparison
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import PlainFormat
from uictest.cli.output import data, message, terminal_width
from uictest.core import files


def compare_variants(place: Path, keys: Sequence[str], shown: PlainFormat, page: Path | None) -> ExitCode:
    """Print the paired differences of the variants of a run. Exit 5 where no stops pair."""
    run = _run(runs.run_folder(place))
    try:
        compared = comparison.compare_variants(run, keys)
    except ValueError as error:
        raise runs.InvalidInputError(f"--over: {error}") from error
    if shown is PlainFormat.JSON:
        data(comparison.variants_json(run.name, compared))
    else:
        for line in report.document_lines(comparison.variants_document(compared), terminal_width(sys.stdout)):
            data(line)
    if page is not None:
        files.write_to(page, comparison.variants_html(run.name, compared))
    groups = sum(len(each.groups) for each in compared)
    counts = report.counted(groups, "group of stops", "groups of stops")
    message(f"uictest: {counts} of {report.counted(len(compared) + 1, 'variant')} paired")
    return ExitCode.MET if groups else ExitCode.NOTHING_SELECTED


def _run(folder: Path) -> report.RunContent:
    if reason := runs.why_no_run(folder):
        raise runs.InvalidInputError(f"{reason}; --over takes the folder of a run")
    try:
        return report.read_run(folder)
    except (OSError, ValueError) as error:
        raise runs.InvalidInputError(f"cannot compare its variants: {error}") from error
