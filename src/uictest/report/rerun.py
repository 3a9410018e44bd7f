"""The commands that run cases again as a run did."""

from __future__ import annotations

import shlex
from typing import Final

from uictest.report.content import CASES_IN_PYTHON, RunContent
from uictest.report.words import argument, printable

_WITH_VALUE: Final = ("--set", "--seed", "--repeat", "--trust")
"""Options of `uictest run` that change what a case is, or which files it may read."""
_FLAGS: Final = ("--in-process", "--real-time", "--firm", "--strict")


def rerun_commands(content: RunContent) -> dict[str, str]:
    """Return the command for every case, by id. A stop of a series cannot run without the series."""
    commands = {result.id: rerun_command(content, result.scenario, result.id) for result in content.results}
    for series in content.series:
        command = rerun_command(content, series.file, series.id)
        commands |= {stop.case.id: command for stop in series.cases}
    return commands


def rerun_command(content: RunContent, file: str, name: str) -> str:
    """Return the command that runs one case or series again; empty where there is none.

    The command keeps the options of the run that change a case. There is none for recorded stops, nor for
    cases that a program loaded: its changes to them are not known.

    Args:
        content: the run, whose manifest holds its command line.
        file: path of the scenario or series file.
        name: id of the case or series.

    """
    command = content.manifest.command
    if tuple(command[1:2]) != ("run",) or CASES_IN_PYTHON in command:
        return ""
    options: list[str] = []
    words = iter(command[2:])
    for word in words:
        if word in _WITH_VALUE:
            options += [word, next(words, "")]
        elif word in _FLAGS or word.startswith(tuple(f"{option}=" for option in _WITH_VALUE)):
            options.append(word)
    chosen = " and not ".join([name, *_longer_names(content, file, name)])
    return printable(f"uictest run {argument(file)} {shlex.join([*options, '-k', chosen])}")


def _longer_names(content: RunContent, file: str, name: str) -> list[str]:
    """Return the ids in a file that contain a name, which would select them as well."""
    if name.endswith("]"):  # the values of a case end it
        return []
    ids = [result.id for result in content.results if result.scenario == file]
    ids += [series.id for series in content.series if series.file == file]
    return [each for each in ids if each != name and name.casefold() in each.casefold()]
