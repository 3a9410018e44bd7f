"""`--lf`: the cases that did not meet their expectation in the newest run."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from uictest import report, runs
from uictest.cli.output import message
from uictest.core import files
from uictest.plans import scenario, series
from uictest.running import campaign


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
    not_met = _not_met(run)
    selected = campaign.by_id(cases, not_met), campaign.by_id(planned, not_met)
    if any(selected):
        return selected
    message(f"uictest: none of these cases failed in {run.name}: all are selected")
    return list(cases), list(planned)


def _newest_run(output: Path) -> Path | None:
    """Return the newest run of scenarios: `latest`, or the newest other folder if that judged recordings."""
    latest = files.latest_run(output)
    if latest is None or not _is_of_recordings(latest):
        return latest
    manifests = sorted(output.glob("*/manifest.json"), key=_age, reverse=True)
    return next((file.parent for file in manifests if _command(file.parent) == "run"), None)


def _age(manifest: Path) -> tuple[str, int]:
    """Return the key that sorts runs by their start: the second in the name, then the time of the file."""
    return manifest.parent.name.partition("-")[0], manifest.stat().st_mtime_ns


def _is_of_recordings(run: Path) -> bool:
    return _command(run) == "evaluate"


def _command(run: Path) -> str:
    """Return the command that made a run; empty if it cannot be read."""
    try:
        return str(json.loads((run / "manifest.json").read_bytes())["command"][1])
    except (OSError, ValueError, RecursionError, LookupError, TypeError):
        return ""


def _not_met(run: Path) -> frozenset[str]:
    path = run / report.RESULTS
    try:
        content = report.run_content(json.loads(path.read_text(encoding="utf-8")), run.name)
    except (OSError, ValueError, RecursionError, KeyError, TypeError, AttributeError) as error:
        raise runs.InvalidInputError(f"{path} cannot be read as the results of a run: {error}") from error
    missed = [result.id for result in content.results if not result.met]
    return frozenset([*missed, *(result.id for result in content.series if not result.met)])
