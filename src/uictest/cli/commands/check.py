"""`uictest check`: validate scenario, sweep and series files without simulating them."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from uictest import report, runs
from uictest.cli.options import CheckFormat, Format, Paths, StrictCheck, Trusted
from uictest.cli.output import ExitCode, data, message, warn_of_implausible
from uictest.plans import scenario, series, sweeps
from uictest.plans.scenario import yaml

_FIELDS = ("file", "line", "column", "key", "message", "hint")


def check(
    paths: Paths = None,
    trusted: Trusted = None,
    shown: CheckFormat = Format.TEXT,
    strict: StrictCheck = False,
) -> ExitCode:
    """Validate scenario, sweep and series files and what they refer to. Every error comes with its place."""
    places = runs.scenario_paths(paths)
    scenarios = [path for path in places if not (runs.is_sweep(path) or runs.is_series(path))]
    errors, counts, checked = _scenarios(scenarios, trusted or ())
    sweep_paths, series_paths = list(runs.sweep_files(places)), list(runs.series_files(places))
    for path, load in [
        *((each, _load_sweep) for each in sweep_paths),
        *((each, _load_series) for each in series_paths),
    ]:
        if path not in places and not scenario.Roots.of(places, trusted or ()).contain(path):
            errors.append(scenario.link_outside(path))
            continue
        with yaml.collecting(errors, yaml.whole_file(path)):
            checked += load(path, trusted or ())
    implausible = runs.implausible_trains(checked)
    errors += implausible if strict else ()
    warn_of_implausible(() if strict else implausible)
    if errors:
        _show(errors, shown)
        message(f"uictest: {report.counted(len(errors), 'error')}")
        return ExitCode.ERROR if any(each.trace for each in errors) else ExitCode.USAGE
    if shown is Format.JSON:
        data("[]")
    sweeping = report.counted(len(sweep_paths), "sweep") if sweep_paths else ""
    of_series = f"{len(series_paths)} series" if series_paths else ""
    warned = f", {report.counted(len(implausible), 'warning')}" if implausible else ""
    message(f"uictest: {' and '.join(filter(None, (counts, sweeping, of_series)))}, no error{warned}")
    return ExitCode.MET


def _scenarios(
    paths: Sequence[Path], trusted: Sequence[Path]
) -> tuple[list[yaml.Diagnostic], str, list[scenario.Case]]:
    """Return the errors of scenario files, in words how many files and cases are without, and the cases."""
    try:
        cases = scenario.load(paths, trusted=trusted)
        _require_fit(cases)
    except yaml.ScenarioErrors as errors:
        return list(errors.diagnostics), "", []
    files = {case.path for case in cases}
    counts = f"{report.counted(len(files), 'scenario')} with {report.counted(len(cases), 'case')}"
    return [], counts if files else "", cases


def _misfits(case: scenario.Case) -> Iterator[yaml.Diagnostic]:
    """Yield why the stop of a case is invalid before it is run: its compensation is for another rig."""
    for each in scenario.misfits(case.scenario):
        yield yaml.diagnose(_place(case, each.key), each.sentence, each.key, scenario.FIT_HINT)


def _place(case: scenario.Case, key: str) -> yaml.Place:
    """Return where the file of a case, or one that it refers to, sets a key; else the whole file."""
    return runs.place_of_key(case.path, key) or yaml.whole_file(case.path)


def _reference_problem(path: str) -> str:
    """Return why a run could not read the validation that scenarios name; empty where it can."""
    try:
        runs.read_reference(Path(path))
    except runs.InvalidInputError as error:
        return "; ".join(error.messages)
    return ""


def _require_fit(cases: Iterable[scenario.Case]) -> None:
    """Raise ScenarioErrors for what is valid by itself and could not be run as it is meant."""
    every = list(cases)
    validated = {case.scenario.validated for case in every}
    problems = {path: _reference_problem(path) for path in validated if path is not None}
    unreadable = (
        yaml.diagnose(_place(case, "validated"), problem, "validated")
        for case in every
        if (problem := problems.get(case.scenario.validated or ""))
    )
    misfits = (each for case in every for each in _misfits(case))
    if unfit := tuple(dict.fromkeys((*unreadable, *misfits))):
        raise yaml.ScenarioErrors(unfit)


def _load_series(path: Path, trusted: Sequence[Path]) -> list[scenario.Case]:
    cases = [case for one in series.load_series(path, trusted=trusted) for case in one.cases]
    _require_fit(cases)
    return cases


def _load_sweep(path: Path, trusted: Sequence[Path]) -> list[scenario.Case]:
    plan = sweeps.load_sweep(path, trusted=trusted)
    _require_fit([plan.base])
    for each in sweeps.drawn_ranges(plan):
        if not each.contains_nominal:
            message(f"{plan.file}: warning: {each}; sensitivities hold for the range only")
    return [plan.base]


def _show(diagnostics: Sequence[yaml.Diagnostic], shown: Format) -> None:
    if shown is Format.JSON:
        data(json.dumps([{name: getattr(each, name) for name in _FIELDS} for each in diagnostics], indent=2))
        return
    for each in diagnostics:
        if shown is Format.GITHUB:
            title = each.key or "scenario"
            data(report.annotation(str(each.file), title, each.message, each.line, each.column))
        if each.trace:
            message(each.trace)
        message(str(each))
