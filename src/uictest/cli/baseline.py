"""`--baseline`: the results of a run against those that were accepted before."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING

from uictest.cli.exit_codes import ExitCode
from uictest.cli.problems import InvalidInputError
from uictest.cli.streams import message

if TYPE_CHECKING:
    from uictest.comparison import Tolerances

_KEPT = ("results.json", "manifest.json")


def against_baseline(run: Path, baseline: Path, tolerances: Tolerances, *, quiet: bool) -> ExitCode:
    """Show on stderr how a run differs from the baseline; MISSED where that is out of tolerance.

    Raises InvalidInputError where the baseline cannot be read.
    """
    from uictest.comparison import compare_run_folders, comparison_lines, verdict_line

    try:
        compared = compare_run_folders(baseline, run, tolerances)
    except (OSError, ValueError) as error:
        raise InvalidInputError(
            f"uictest: {baseline} is no baseline: {error}; --accept makes the results of a run one"
        ) from error
    for line in comparison_lines(compared):
        message(line)
    if not quiet or not compared.agrees:
        message(f"uictest: against {baseline}: {verdict_line(compared)}")
    return ExitCode.MET if compared.agrees else ExitCode.MISSED


def accept(run: Path, baseline: Path) -> None:
    """Make the results of a run the baseline. Raises OSError."""
    from uictest.recording import atomic_path

    baseline.mkdir(parents=True, exist_ok=True)
    for name in _KEPT:
        with atomic_path(baseline / name) as temporary:
            shutil.copyfile(run / name, temporary)
    message(f"uictest: {baseline} now holds the results of {run.name}")
