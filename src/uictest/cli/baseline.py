"""`--baseline`: the results of a run against those that were accepted before."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from uictest import comparison, evaluation, recording, report, scenario
from uictest.cli.exit_codes import ExitCode
from uictest.cli.problems import InvalidInputError
from uictest.cli.streams import message
from uictest.scenario import yaml

if TYPE_CHECKING:
    from uictest.cli.batch import Published


def scope_of(selected: Sequence[scenario.Case], searched: Sequence[Path]) -> comparison.Scope:
    """Return what a run was asked for; `searched` are the files and folders of which it takes every case."""
    return comparison.Scope(
        frozenset(case.id for case in selected), [yaml.display_name(path) for path in searched]
    )


def open_baseline(
    folder: Path, scope: comparison.Scope, tolerances: comparison.Tolerances, *, accepting: bool
) -> comparison.Baseline | None:
    """Return the baseline in a folder; None where the run that is accepted is the first one there.

    Raises InvalidInputError where it cannot be read.
    """
    if accepting and not (folder / report.RESULTS).exists():
        return None
    way_out = (
        f"remove {folder} to start a new one" if accepting else "--accept makes the results of a run one"
    )
    try:
        return comparison.read_baseline(folder, scope, tolerances)
    except OSError as error:
        reason = f"{error.filename}: {error.strerror}"
        raise InvalidInputError(f"uictest: {folder} is no baseline: {reason}; {way_out}") from error
    except ValueError as error:
        raise InvalidInputError(f"uictest: {folder} is no baseline: {error}; {way_out}") from error


def show_comparison(baseline: report.BaselineComparison | None, *, quiet: bool) -> ExitCode:
    """Show on stderr how the run compares with its baseline, if with any; with `quiet` only where it differs.

    Returns MISSED where it differs, else MET.
    """
    if baseline is None or (quiet and baseline.agrees):
        return ExitCode.MET
    for note in baseline.notes:
        message(f"note: {note}")
    for sentence in report.not_compared_sentences(baseline):
        message(f"uictest: {sentence}")
    message(f"uictest: {report.baseline_summary(baseline)}")
    return ExitCode.MET if baseline.agrees else ExitCode.MISSED


def accept_run(run: Published, folder: Path, baseline: comparison.Baseline | None) -> None:
    """Make the results of a run the baseline; what the run did not select stays. Raises OSError."""
    document = comparison.accepted_document(json.loads(run.document), baseline)
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in (("manifest.json", document["manifest"]), (report.RESULTS, document)):
        recording.write_text_atomic(folder / name, evaluation.to_json(content))
    kept = len(document["cases"]) - len(run.content.results)
    others = f"; {report.counted(kept, 'case')} that did not run stay as they were" if kept else ""
    message(f"uictest: {folder} now holds the results of {run.place.name}{others}")
