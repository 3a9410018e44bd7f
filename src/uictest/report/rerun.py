"""The commands that run cases again as a run did."""

from __future__ import annotations

import shlex
from typing import Final

from uictest.report.content import CASES_IN_PYTHON, RunContent, RunManifest
from uictest.report.words import argument, printable

_WITH_VALUE: Final = ("--set", "--seed", "--repeat", "--trust")
"""Options of `uictest run` that change what a case is, or which files it may read."""
_FLAGS: Final = ("--in-process", "--real-time", "--firm", "--strict")


def rerun_commands(content: RunContent) -> dict[str, str]:
    """Return the command for every case, by id. A stop of a series cannot run without the series."""
    manifest = content.manifest
    commands = {result.id: rerun_command(manifest, result.scenario, result.id) for result in content.results}
    for series in content.series:
        command = rerun_command(manifest, series.file, series.id)
        commands |= {stop.case.id: command for stop in series.cases}
    return commands


def rerun_command(manifest: RunManifest, file: str, name: str) -> str:
    """Return the command that runs one case or series again; empty where there is none.

    The command keeps the options of the run that change a case. There is none for recorded stops, nor for
    cases that a program loaded: its changes to them are not known.

    Args:
        manifest: manifest of the run, which holds its command line.
        file: path of the scenario or series file.
        name: id of the case or series.

    """
    if tuple(manifest.command[1:2]) != ("run",) or CASES_IN_PYTHON in manifest.command:
        return ""
    options: list[str] = []
    words = iter(manifest.command[2:])
    for word in words:
        if word in _WITH_VALUE:
            options += [word, next(words, "")]
        elif word in _FLAGS or word.startswith(tuple(f"{option}=" for option in _WITH_VALUE)):
            options.append(word)
    return printable(f"uictest run {argument(file)} {shlex.join([*options, '-k', name])}")
