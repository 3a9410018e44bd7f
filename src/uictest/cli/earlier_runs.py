"""Earlier runs: `--lf` takes what failed last, `--baseline` compares, `--keep` removes the oldest."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import typer

from uictest import report, runs
from uictest.analysis import comparison
from uictest.cli.output import ExitCode, message
from uictest.core import files
from uictest.judging import evaluation
from uictest.plans import scenario, series
from uictest.plans.scenario import yaml
from uictest.running import campaign
from uictest.runs import history


class BaselineChoice(NamedTuple):
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
    """Return the selection of a run; `searched` are paths of which it takes every case and series."""
    return comparison.Scope(
        frozenset([*(case.id for case in selected), *(one.id for one in planned)]),
        [yaml.display_name(path) for path in searched],
    )


def open_baseline(choice: BaselineChoice, scope: comparison.Scope) -> comparison.Baseline | None:
    """Return the baseline; None without one, or if the first run is accepted.

    Raises InvalidInputError where it cannot be read.
    """
    folder = choice.folder
    holds_results = folder is not None and (folder / report.RESULTS).exists()
    if folder is None or (choice.accepting and not holds_results):
        return None
    advice = f"{f'remove {folder} first: ' if holds_results else ''}--accept makes a run the baseline"
    try:
        return comparison.read_baseline(folder, scope, choice.tolerances)
    except OSError as error:
        reason = f"{error.filename}: {error.strerror}"
        raise runs.InvalidInputError(f"{folder} is no baseline: {reason}; {advice}") from error
    except ValueError as error:
        raise runs.InvalidInputError(f"{folder} is no baseline: {error}; {advice}") from error


def accept_or_compare(
    choice: BaselineChoice, accepted: comparison.Baseline | None, published: runs.Published, *, quiet: bool
) -> ExitCode:
    """Accept a run as the baseline, or show the comparison on stderr; do nothing without a baseline.

    If `quiet`, a run that agrees shows nothing. Returns MISSED where it differs, else MET. Raises OSError.
    """
    if choice.folder is None:
        return ExitCode.MET
    if choice.accepting and published.interrupted:
        message(f"uictest: interrupted: {choice.folder} is unchanged")
        return ExitCode.MET
    if choice.accepting:
        _accept_baseline(published, choice.folder, accepted)
        return ExitCode.MET
    compared = published.content.baseline
    if compared is None or (quiet and compared.agrees):
        return ExitCode.MET
    for note in compared.notes:
        message(f"note: {note}")
    for sentence in report.not_compared_sentences(compared):
        message(f"uictest: {sentence}")
    message(f"uictest: {report.baseline_summary(compared)}")
    return ExitCode.MET if compared.agrees else ExitCode.MISSED


def _accept_baseline(run: runs.Published, folder: Path, baseline: comparison.Baseline | None) -> None:
    """Make the results of a run the baseline, and keep cases that it did not select. Raises OSError."""
    document = comparison.accepted_document(json.loads(run.publication.texts[report.RESULTS]), baseline)
    files.make_folder(folder)
    for name, content in (("manifest.json", document["manifest"]), (report.RESULTS, document)):
        files.write(folder, name, evaluation.to_json(content))
    history.write_entry(folder, report.run_content(document, folder.resolve().name))
    unchanged = len(document["cases"]) - len(run.content.results)
    others = f"; {report.counted(unchanged, 'case')} that did not run are unchanged" if unchanged else ""
    message(f"uictest: {folder} now holds the results of {run.place.name}{others}")


def failed_last(
    cases: Sequence[scenario.Case], planned: Sequence[series.Series], output: Path
) -> tuple[list[scenario.Case], list[series.Series]]:
    """Return the cases and the series that failed last; if none is known, all of them, with a message.

    Raises InvalidInputError where the results of the newest run cannot be read.
    """
    run = _newest_run(output)
    if run is None:
        message(f"uictest: no earlier run in {output}: all cases are selected")
        return list(cases), list(planned)
    path = run / report.RESULTS
    try:
        content = report.run_content(json.loads(path.read_text(encoding="utf-8")), run.name)
    except (OSError, ValueError, RecursionError, KeyError, TypeError, AttributeError) as error:
        raise runs.InvalidInputError(f"{path} cannot be read as the results of a run: {error}") from error
    not_met = frozenset(
        [
            *(case.id for case in content.results if not case.met),
            *(one.id for one in content.series if not one.met),
        ]
    )
    selected = campaign.by_id(cases, not_met), campaign.by_id(planned, not_met)
    if any(selected):
        return selected
    message(f"uictest: none of these cases failed in {run.name}: all are selected")
    return list(cases), list(planned)


def _newest_run(output: Path) -> Path | None:
    """Return the newest run of scenarios: `latest`, or the newest other folder if that judged recordings."""
    latest = files.latest_run(output)
    if latest is None or _command_of_run(latest) not in history.OF_RECORDINGS:
        return latest

    def start(manifest: Path) -> tuple[str, int]:
        """Return the second in the name of a run, then the time of its file."""
        return manifest.parent.name.partition("-")[0], manifest.stat().st_mtime_ns

    manifests = sorted(output.glob("*/manifest.json"), key=start, reverse=True)
    return next((file.parent for file in manifests if _command_of_run(file.parent) == "run"), None)


def _command_of_run(run: Path) -> str:
    """Return the command that made a run; empty if it cannot be read."""
    try:
        return str(json.loads((run / "manifest.json").read_bytes())["command"][1])
    except (OSError, ValueError, RecursionError, LookupError, TypeError):
        return ""


def named_paths(*paths: Path | None) -> list[Path]:
    """Return the targets of paths on the command line before the run, after which `latest` moves."""
    return [Path(os.path.realpath(path)) for path in paths if path is not None]


def keep_newest(
    code: ExitCode, keep: int | None, run: Path, kind: history.Kind, referred: Sequence[Path] = ()
) -> None:
    """Remove the runs beside a finished one beyond the `keep` newest.

    Does nothing without `keep`. After an interruption or an error (`code`) nothing is removed. `referred` are
    the :func:`named_paths` of the command line: what they lie in stays.
    """
    if keep is None:
        return
    if code not in (ExitCode.MET, ExitCode.MISSED):
        message("uictest: --keep: nothing is removed, as this run did not end as planned")
        return
    removed = False
    try:
        for pruned in history.prune(run.parent, kind, keep, run.name, referred):
            if pruned.kept_because:
                message(f"uictest: --keep {keep}: {pruned.name} stays: {pruned.kept_because}")
            else:
                message(f"uictest: --keep {keep}: removed {pruned.name}, older than the newest {keep}")
                removed = True
    except OSError as error:
        message(f"uictest: --keep: {error.filename or run.parent}: {error.strerror or error}")
        return
    if removed and (problem := history.refresh_index(run.parent)):
        message(f"uictest: {problem}")
