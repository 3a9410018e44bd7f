"""`uictest check`: validate scenario, sweep, series and programme files without simulating them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from uictest import report, runs
from uictest.cli.options import CheckFormat, Format, Paths, StrictCheck, Trusted
from uictest.cli.output import ExitCode, data, message, warn_of_implausible
from uictest.plans import scenario, search, series, sweeps
from uictest.plans.scenario import yaml

_FIELDS = ("file", "line", "column", "key", "message", "hint")


def check(
    paths: Paths = None,
    trusted: Trusted = None,
    shown: CheckFormat = Format.TEXT,
    strict: StrictCheck = False,
) -> ExitCode:
    """Validate scenarios, sweeps, series and programmes. Every error comes with its place."""
    named = runs.scenario_paths(paths)
    others = (runs.is_sweep, runs.is_series, runs.is_programme)
    scenarios = [path for path in named if not any(is_other(path) for is_other in others)]
    errors, counts, checked = _scenarios(scenarios, trusted or ())
    sweep_paths, series_paths = list(runs.sweep_files(named)), list(runs.series_files(named))
    programme_paths = list(runs.programme_files(named))
    loaders = [(_load_sweep, path) for path in sweep_paths] + [(_load_series, path) for path in series_paths]
    loaders += [(_load_programme, path) for path in programme_paths]
    for load, path in loaders:
        if path not in named and not scenario.Roots.of(named, trusted or ()).contain(path):
            errors.append(scenario.link_outside(path))
            continue
        with yaml.collecting(errors, yaml.whole_file(path)):
            checked += load(path, trusted or ())
    errors += [] if errors else search.searches_in(scenarios, trusted or ())
    implausible = runs.implausible_trains(checked)
    errors += implausible if strict else ()
    warn_of_implausible(() if strict else implausible)
    if errors:
        _show_diagnostics(errors, shown)
        message(f"uictest: {report.counted(len(errors), 'error')}")
        return ExitCode.ERROR if any(error.trace for error in errors) else ExitCode.USAGE
    if shown is Format.JSON:
        data("[]")
    sweeping = report.counted(len(sweep_paths), "sweep") if sweep_paths else ""
    of_series = f"{len(series_paths)} series" if series_paths else ""
    of_tests = report.counted(len(programme_paths), "programme") if programme_paths else ""
    warned = f", {report.counted(len(implausible), 'warning')}" if implausible else ""
    message(
        f"uictest: {' and '.join(filter(None, (counts, sweeping, of_series, of_tests)))}, no error{warned}"
    )
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


def _require_fit(cases: Sequence[scenario.Case]) -> None:
    """Raise ScenarioErrors for what is valid by itself and could not be run as it is meant.

    A validation that cannot be read, or a compensation that is for another rig.
    """
    unreadable: dict[str, str] = {}
    for path in {case.scenario.validated for case in cases} - {None}:
        try:
            runs.read_reference(Path(str(path)))
        except runs.InvalidInputError as error:
            unreadable[str(path)] = "; ".join(error.messages)
    problems = [
        yaml.diagnose(_location_of_key(case, "validated"), reason, "validated")
        for case in cases
        if (reason := unreadable.get(case.scenario.validated or ""))
    ]
    for case in cases:
        for misfit in scenario.misfits(case.scenario):
            place = _location_of_key(case, misfit.key)
            problems.append(yaml.diagnose(place, misfit.sentence, misfit.key, scenario.FIT_HINT))
    if problems:
        raise yaml.ScenarioErrors(tuple(dict.fromkeys(problems)))


def _location_of_key(case: scenario.Case, key: str) -> yaml.Location:
    """Return the location of a key in the file of a case or one that it refers to; else the whole file."""
    return runs.place_of_key(case.path, key) or yaml.whole_file(case.path)


def _load_series(path: Path, trusted: Sequence[Path]) -> list[scenario.Case]:
    cases = [case for one in series.load_series(path, trusted=trusted) for case in one.cases]
    _require_fit(cases)
    return cases


def _load_programme(path: Path, trusted: Sequence[Path]) -> list[scenario.Case]:
    cases = series.load_programme(path, trusted=trusted).cases
    _require_fit(cases)
    return cases


def _load_sweep(path: Path, trusted: Sequence[Path]) -> list[scenario.Case]:
    plan = sweeps.load_sweep(path, trusted=trusted)
    _require_fit([plan.base])
    for drawn in sweeps.drawn_ranges(plan):
        if not drawn.contains_nominal:
            message(f"{plan.file}: warning: {drawn}; sensitivities hold for the range only")
    return [plan.base]


def _show_diagnostics(diagnostics: Sequence[yaml.Diagnostic], shown: Format) -> None:
    if shown is Format.JSON:
        errors = [{name: getattr(error, name) for name in _FIELDS} for error in diagnostics]
        data(json.dumps(errors, indent=2))
        return
    for error in diagnostics:
        if shown is Format.GITHUB:
            title = error.key or "scenario"
            data(report.annotation(str(error.file), title, error.message, error.line, error.column))
        if error.trace:
            message(error.trace)
        message(str(error))
