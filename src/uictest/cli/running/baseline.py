"""`--baseline`: compare the results of a run with accepted ones, or accept them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import typer

from uictest import report, runs
from uictest.analysis import comparison
from uictest.cli.exit_codes import ExitCode
from uictest.cli.output import message
from uictest.core import files
from uictest.judging import evaluation
from uictest.plans import scenario, series
from uictest.plans.scenario import yaml


@dataclass(frozen=True, slots=True)
class BaselineChoice:
    """The options `--baseline`, `--accept` and `--tolerance`; `folder` is None without a baseline."""

    folder: Path | None
    tolerances: comparison.Tolerances
    accepting: bool

    @classmethod
    def of(cls, folder: Path | None, tolerances: comparison.Tolerances, *, accepting: bool) -> BaselineChoice:
        """Return the choice. Raises typer.BadParameter for `--accept` without a baseline."""
        if accepting and folder is None:
            raise typer.BadParameter("there is no --baseline to update", param_hint="--accept")
        return cls(folder, tolerances, accepting)


def scope_of(
    selected: Sequence[scenario.Case], planned: Sequence[series.Series], searched: Sequence[Path]
) -> comparison.Scope:
    """Return what a run selects; `searched` are paths of which it takes every case and series."""
    return comparison.Scope(
        frozenset([*(case.id for case in selected), *(each.id for each in planned)]),
        [yaml.display_name(path) for path in searched],
    )


def open_baseline(choice: BaselineChoice, scope: comparison.Scope) -> comparison.Baseline | None:
    """Return the baseline; None without one, or if the first run is accepted.

    Raises InvalidInputError where it cannot be read.
    """
    folder = choice.folder
    if folder is None or (choice.accepting and not (folder / report.RESULTS).exists()):
        return None
    advice = (
        f"remove {folder} to start a new one"
        if choice.accepting
        else "--accept makes the results of a run the baseline"
    )
    try:
        return comparison.read_baseline(folder, scope, choice.tolerances)
    except OSError as error:
        reason = f"{error.filename}: {error.strerror}"
        raise runs.InvalidInputError(f"{folder} is no baseline: {reason}; {advice}") from error
    except ValueError as error:
        raise runs.InvalidInputError(f"{folder} is no baseline: {error}; {advice}") from error


def accept_or_compare(
    choice: BaselineChoice,
    accepted: comparison.Baseline | None,
    published: runs.Published,
    *,
    quiet: bool,
) -> ExitCode:
    """Accept a run as the baseline, or show the comparison; do nothing without a baseline.

    Returns MISSED where the run differs, else MET. Raises OSError.
    """
    if choice.folder is None:
        return ExitCode.MET
    if not choice.accepting:
        return _show_comparison(published.content.baseline, quiet=quiet)
    if published.interrupted:
        message(f"uictest: interrupted: {choice.folder} is unchanged")
    else:
        _accept(published, choice.folder, accepted)
    return ExitCode.MET


def _show_comparison(baseline: report.BaselineComparison | None, *, quiet: bool) -> ExitCode:
    """Show the comparison with the baseline on stderr; if `quiet`, only if the run differs.

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


def _accept(run: runs.Published, folder: Path, baseline: comparison.Baseline | None) -> None:
    """Make the results of a run the baseline, and keep cases that it did not select. Raises OSError."""
    document = comparison.accepted_document(json.loads(run.document), baseline)
    files.make_folder(folder)
    for name, content in (("manifest.json", document["manifest"]), (report.RESULTS, document)):
        files.write(folder, name, evaluation.to_json(content))
    kept = len(document["cases"]) - len(run.content.results)
    others = f"; {report.counted(kept, 'case')} that did not run are unchanged" if kept else ""
    message(f"uictest: {folder} now holds the results of {run.place.name}{others}")
