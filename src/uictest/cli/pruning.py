"""`--keep`: remove older runs after a run, and say which."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from uictest.cli.exit_codes import ExitCode
from uictest.cli.output import message
from uictest.runs import history


def named_paths(*paths: Path | None) -> list[Path]:
    """Return where paths of the command line lead before the run, after which `latest` leads elsewhere."""
    return [Path(os.path.realpath(path)) for path in paths if path is not None]


def keep_newest(
    code: ExitCode, keep: int | None, run: Path, kind: history.Kind, referred: Sequence[Path] = ()
) -> ExitCode:
    """Remove the runs beside a finished one beyond the `keep` newest, and return the exit code as it is.

    Does nothing without `keep`. After an interruption or an error nothing is removed. `referred` are the
    :func:`named_paths` of the command line: what they lie in stays.
    """
    if keep is None:
        return code
    if code not in (ExitCode.MET, ExitCode.MISSED):
        message("uictest: --keep: nothing is removed, as this run did not end as planned")
        return code
    try:
        fates = [_shown(each, keep) for each in history.prune(run.parent, kind, keep, run.name, referred)]
    except OSError as error:
        message(f"uictest: --keep: {error.filename or run.parent}: {error.strerror or error}")
        return code
    if any(fates) and (problem := history.refresh_index(run.parent)):
        message(f"uictest: {problem}")
    return code


def _shown(fate: history.Pruned, keep: int) -> bool:
    """Say what became of a run; return whether it was removed."""
    if fate.kept_because:
        message(f"uictest: --keep {keep}: {fate.name} stays: {fate.kept_because}")
    else:
        message(f"uictest: --keep {keep}: removed {fate.name}, older than the newest {keep}")
    return not fate.kept_because
