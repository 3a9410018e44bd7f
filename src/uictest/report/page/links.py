"""Places on a page that links lead to, and the command that runs one of its cases again."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path
from urllib.parse import quote

from uictest.report.content import RunContent
from uictest.report.escaping import argument, printable
from uictest.report.manifest import CASES_IN_PYTHON, RunManifest


def case_anchor(case_id: str) -> str:
    """Return the `id` of the element that shows a case, e.g. `case-slip-120[friction=0.09]`."""
    return f"case-{printable(case_id)}"


def series_anchor(series_id: str) -> str:
    """Return the `id` of the element that shows a series, e.g. `series-acceptance`."""
    return f"series-{printable(series_id)}"


def fragment(anchor: str) -> str:
    """Return an anchor as it stands behind the `#` of a link: percent-encoded."""
    return quote(anchor, safe="")


_WITH_VALUE = ("--set", "--seed", "--repeat", "--trust")
"""Options of `uictest run` that change what a case is, or which files it may read."""
_FLAGS = ("--in-process", "--real-time")


def rerun_commands(content: RunContent) -> dict[str, str]:
    """Return the command for every case, by id. A stop of a series cannot run without the series."""
    of_cases = {each.id: rerun_command(content.manifest, each.scenario, each.id) for each in content.results}
    of_series = {
        each.case.id: rerun_command(content.manifest, series.file, series.id)
        for series in content.series
        for each in series.cases
    }
    return {**of_cases, **of_series}


def rerun_command(manifest: RunManifest, file: str, name: str) -> str:
    """Return the command that runs one case or series again; empty where there is none.

    It keeps the options of the run that change a case. Recorded stops are not run, and what a program changed
    while it loaded cases is not known.

    Args:
        manifest: of the run.
        file: of the scenario or series.
        name: id of the case or series.

    """
    if tuple(manifest.command[1:2]) != ("run",) or CASES_IN_PYTHON in manifest.command:
        return ""
    options = shlex.join([*_kept(manifest.command[2:]), "-k", name])
    return printable(f"uictest run {argument(file)} {options}")


def _kept(arguments: Sequence[str]) -> Iterator[str]:
    words = iter(arguments)
    for word in words:
        if word in _WITH_VALUE:
            yield from (word, next(words, ""))
        elif word in _FLAGS or word.startswith(tuple(f"{option}=" for option in _WITH_VALUE)):
            yield word


def may_replace(path: Path, mark: str) -> bool:
    """Return whether a page may be written here: there is none yet, or one with this mark.

    A template writes the mark as the attribute `data-document`. Raises OSError.
    """
    if path.is_symlink():
        return False
    if not path.exists():
        return True
    return path.is_file() and f'data-document="{mark}"'.encode() in path.read_bytes()
