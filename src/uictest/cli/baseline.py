"""`--baseline`: the results of a run against those that were accepted before."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from uictest.cli.exit_codes import ExitCode
from uictest.cli.problems import InvalidInputError
from uictest.cli.streams import message

if TYPE_CHECKING:
    from uictest.cli.batch import Published
    from uictest.comparison import Baseline, Scope, Tolerances
    from uictest.report import BaselineComparison
    from uictest.scenario import Case


def scope_of(selected: Sequence[Case], searched: Sequence[Path]) -> Scope:
    """Return what a run was asked for; `searched` are the files and folders of which it takes every case."""
    from uictest.comparison import Scope
    from uictest.scenario.reading import display_name

    return Scope(frozenset(case.id for case in selected), [display_name(path) for path in searched])


def open_baseline(folder: Path, scope: Scope, tolerances: Tolerances, *, accepting: bool) -> Baseline | None:
    """Return the baseline in a folder; None where the run that is accepted is the first one there.

    Raises InvalidInputError where it cannot be read.
    """
    from uictest.comparison import read_baseline
    from uictest.report import RESULTS

    if accepting and not (folder / RESULTS).exists():
        return None
    way_out = (
        f"remove {folder} to start a new one" if accepting else "--accept makes the results of a run one"
    )
    try:
        return read_baseline(folder, scope, tolerances)
    except OSError as error:
        reason = f"{error.filename}: {error.strerror}"
        raise InvalidInputError(f"uictest: {folder} is no baseline: {reason}; {way_out}") from error
    except ValueError as error:
        raise InvalidInputError(f"uictest: {folder} is no baseline: {error}; {way_out}") from error


def show_comparison(baseline: BaselineComparison | None, *, quiet: bool) -> ExitCode:
    """Show on stderr how the run compares with its baseline, if with any; with `quiet` only where it differs.

    Returns MISSED where it differs, else MET.
    """
    from uictest.report import baseline_summary, not_compared_sentences

    if baseline is None or (quiet and baseline.agrees):
        return ExitCode.MET
    for note in baseline.notes:
        message(f"note: {note}")
    for sentence in not_compared_sentences(baseline):
        message(f"uictest: {sentence}")
    message(f"uictest: {baseline_summary(baseline)}")
    return ExitCode.MET if baseline.agrees else ExitCode.MISSED


def accept_run(run: Published, folder: Path, baseline: Baseline | None) -> None:
    """Make the results of a run the baseline; what the run did not select stays. Raises OSError."""
    from uictest.comparison import accepted_document
    from uictest.evaluation import to_json
    from uictest.recording import write_text_atomic
    from uictest.report import RESULTS, counted

    document = accepted_document(json.loads(run.document), baseline)
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in (("manifest.json", document["manifest"]), (RESULTS, document)):
        write_text_atomic(folder / name, to_json(content))
    kept = len(document["cases"]) - len(run.content.results)
    others = f"; {counted(kept, 'case')} that did not run stay as they were" if kept else ""
    message(f"uictest: {folder} now holds the results of {run.place.name}{others}")
