"""`uictest list`: the ids of cases, or the requirements that they verify."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from uictest import runs
from uictest.cli import sweep as sweeping
from uictest.cli.cases import (
    case_lines,
    case_table,
    cases_json,
    joined_json,
    select_by_options,
    series_json,
    series_lines,
)
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import Expression, ListFormat, Overrides, Paths, PlainFormat, Tag, Trusted, Verbose
from uictest.cli.output import data, message, terminal_width
from uictest.cli.requirement_listing import RequirementRequest, list_requirements
from uictest.plans import scenario, series, sweeps


def list_cases(
    paths: Paths = None,
    expression: Expression = None,
    tag: Tag = None,
    overrides: Overrides = None,
    trusted: Trusted = None,
    requirements: Annotated[
        bool,
        typer.Option("--requirements", help="List requirements and what verifies them instead of cases."),
    ] = False,
    requirement_list: Annotated[
        Path | None,
        typer.Option(
            "--requirement-list",
            metavar="FILE",
            help="All requirements (text, CSV or YAML): with --requirements, shows those not covered, too.",
        ),
    ] = None,
    fail_uncovered: Annotated[
        bool,
        typer.Option("--fail-uncovered", help="With --requirements: exit with 1 if one is not covered."),
    ] = False,
    shown: ListFormat = PlainFormat.TEXT,
    verbose: Verbose = False,
) -> ExitCode:
    """List the ids of all cases, one per line; with -v, titles and tags. Sweeps must be named."""
    if not requirements and (requirement_list is not None or fail_uncovered):
        option = "--fail-uncovered" if requirement_list is None else "--requirement-list"
        raise typer.BadParameter("add --requirements", param_hint=option)
    request = RequirementRequest(requirement_list, fail_uncovered)
    if paths and all(map(runs.is_sweep, paths)):
        if requirements:
            plans = (_plan(path, overrides, trusted) for path in paths)
            return list_requirements([plan.base for plan in plans], request, shown)
        return _list_sweeps(paths, expression, overrides, trusted)
    cases, planned = runs.load_cases_and_series(paths, overrides, None, trusted)
    selected = select_by_options(cases, expression, tag)
    of_series = select_by_options(planned, expression, tag)
    if not (selected or of_series):
        message(f"uictest: {runs.nothing_selected(cases, planned)}")
        return ExitCode.NOTHING_SELECTED
    if requirements:
        return list_requirements(selected, request, shown, of_series)
    _list_selected(selected, of_series, shown, described=verbose)
    return ExitCode.MET


def _list_selected(
    selected: Sequence[scenario.Case],
    of_series: Sequence[series.Series],
    shown: PlainFormat,
    *,
    described: bool,
) -> None:
    width = terminal_width(sys.stdout)
    if shown is PlainFormat.JSON:
        data(joined_json(cases_json(selected), series_json(of_series)))
        return
    if described and width is not None and selected:
        data("\n".join(case_table(selected, width)))
    elif selected:
        data(case_lines(selected, described=described))
    if of_series:
        data(series_lines(of_series, described=described))


def _list_sweeps(
    paths: Sequence[Path],
    expression: str | None,
    overrides: Sequence[str] | None,
    trusted: Sequence[Path] | None,
) -> ExitCode:
    selections = [sweeping.selected_cases(_plan(path, overrides, trusted), expression) for path in paths]
    for selection in selections:
        if not sweeping.show_ids(selection):
            break
    if any(selection.size for selection in selections):
        return ExitCode.MET
    message("uictest: nothing selected")
    return ExitCode.NOTHING_SELECTED


def _plan(path: Path, overrides: Sequence[str] | None, trusted: Sequence[Path] | None) -> sweeps.Plan:
    return sweeps.load_sweep(path, tuple(overrides or ()), trusted=trusted or ())
