"""`uictest check`: whether scenario files are valid. Nothing is simulated."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from uictest import scenario, sweep
from uictest.cli import sweep as sweeping
from uictest.cli.cases import scenario_paths
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import CheckFormat, Format, Paths, Trusted, Verbosity
from uictest.cli.streams import data, message
from uictest.report import annotation, counted
from uictest.scenario import yaml

_FIELDS = ("file", "line", "column", "key", "message", "hint")


def check(
    paths: Paths = None,
    trusted: Trusted = None,
    shown: CheckFormat = Format.TEXT,
    quiet: Annotated[
        bool, typer.Option("-q", "--quiet", help="Say nothing where there is no error.")
    ] = False,
    verbosity: Verbosity = 0,
) -> ExitCode:
    """Validate scenario and sweep files and what they refer to. Every error is shown with its place."""
    given = scenario_paths(paths)
    found, sound = _scenarios([path for path in given if not sweeping.is_sweep(path)], trusted or ())
    sweeps = list(sweeping.sweep_files(given))
    for path in sweeps:
        found.extend(_errors_of_sweep(path, given, trusted or ()))
    if found:
        _show(found, shown)
        message(f"uictest: {counted(len(found), 'error')}")
        return ExitCode.USAGE
    if shown is Format.JSON:
        data("[]")
    if not quiet:
        and_sweeps = f" and {counted(len(sweeps), 'sweep')}" if sweeps else ""
        message(f"uictest: {sound}{and_sweeps}, no error")
    return ExitCode.MET


def _scenarios(paths: Sequence[Path], trusted: Sequence[Path]) -> tuple[list[yaml.Diagnostic], str]:
    """Return the errors of scenario files, and without any how many files and cases there are."""
    try:
        cases = scenario.load(paths, trusted=trusted)
    except yaml.ScenarioErrors as errors:
        return list(errors.diagnostics), ""
    files = {case.path for case in cases}
    return [], f"{counted(len(files), 'scenario')} with {counted(len(cases), 'case')}"


def _errors_of_sweep(path: Path, given: Sequence[Path], trusted: Sequence[Path]) -> Sequence[yaml.Diagnostic]:
    if path not in given and not scenario.Roots.of(given, trusted).contain(path):
        return (scenario.link_outside(path),)
    try:
        plan = sweep.load_sweep(path, trusted=trusted)
    except yaml.ScenarioErrors as errors:
        return errors.diagnostics
    for each in sweep.drawn_ranges(plan):
        if not each.contains_nominal:
            message(f"{plan.file}: warning: {each}; sensitivities hold for the range only")
    return ()


def _show(diagnostics: Sequence[yaml.Diagnostic], shown: Format) -> None:
    if shown is Format.JSON:
        data(
            json.dumps([{name: getattr(found, name) for name in _FIELDS} for found in diagnostics], indent=2)
        )
        return
    for found in diagnostics:
        if shown is Format.GITHUB:
            data(
                annotation(str(found.file), found.key or "scenario", found.message, found.line, found.column)
            )
        message(str(found))
