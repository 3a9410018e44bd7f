"""`uictest list`: the ids of cases, or the requirements that they verify."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final, Literal

import typer

from uictest import runs
from uictest.cli.cases import case_lines, case_table, select_by_options, selection_json, series_lines
from uictest.cli.commands.sweep import selected_cases, show_ids
from uictest.cli.options import (
    Expression,
    ListFormat,
    Overrides,
    Paths,
    PlainFormat,
    Tag,
    Trusted,
    Verbose,
    option,
)
from uictest.cli.output import ExitCode, data, message, terminal_width
from uictest.core.document import Column, Table
from uictest.plans import scenario, series, sweeps
from uictest.report import counted, counted_in, printable, table_lines
from uictest.running import campaign


def list_cases(
    paths: Paths = None,
    expression: Expression = None,
    tag: Tag = None,
    overrides: Overrides = None,
    trusted: Trusted = None,
    requirements: Annotated[
        bool, option("--requirements", "List requirements and what verifies them instead of cases.")
    ] = False,
    requirement_list: Annotated[
        Path | None,
        option(
            "--requirement-list FILE",
            "All requirements (text, CSV or YAML): with --requirements, shows those not covered, too.",
        ),
    ] = None,
    fail_uncovered: Annotated[
        bool, option("--fail-uncovered", "With --requirements: exit with 1 if one is not covered.")
    ] = False,
    shown: ListFormat = PlainFormat.TEXT,
    verbose: Verbose = False,
) -> ExitCode:
    """List the ids of all cases, one per line; with -v, titles and tags. Sweeps must be named."""
    if not requirements and (requirement_list is not None or fail_uncovered):
        option = "--fail-uncovered" if requirement_list is None else "--requirement-list"
        raise typer.BadParameter("add --requirements", param_hint=option)
    request = RequirementRequest(requirement_list, fail_uncovered)
    named = runs.scenario_paths(paths) if paths else []
    if named and all(map(runs.is_sweep, named)):
        if requirements:
            plans = (_plan(path, overrides, trusted) for path in named)
            return list_requirements([plan.base for plan in plans], request, shown)
        return _list_sweeps(named, expression, overrides, trusted)
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
        data(selection_json(selected, of_series))
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
    selections = [selected_cases(_plan(path, overrides, trusted), expression) for path in paths]
    for selection in selections:
        if not show_ids(selection):
            break
    if any(selection.size for selection in selections):
        return ExitCode.MET
    message("uictest: nothing selected")
    return ExitCode.NOTHING_SELECTED


def _plan(path: Path, overrides: Sequence[str] | None, trusted: Sequence[Path] | None) -> sweeps.Plan:
    return sweeps.load_sweep(path, tuple(overrides or ()), trusted=trusted or ())


Status = Literal["covered", "uncovered", "unknown"]
"""unknown: a scenario, series or criterion names it and the list of requirements does not."""


@dataclass(frozen=True, slots=True)
class RequirementRequest:
    """The file with all requirements, if there is one, and whether uncovered ones exit with 1."""

    file: Path | None = None
    fail_uncovered: bool = False


def list_requirements(
    cases: Sequence[scenario.Case],
    request: RequirementRequest,
    shown: PlainFormat,
    of_series: Sequence[series.Series] = (),
) -> ExitCode:
    """List the requirements that cases, series, their criteria or the file name.

    Raises InvalidInputError.
    """
    file = request.file
    listed = None if file is None else frozenset(scenario.read_requirement_list(file))
    coverage = campaign.requirement_coverage(cases, tuple(listed or ()), of_series)
    rows = [(_status(requirement, listed), requirement) for requirement in coverage]
    width = terminal_width(sys.stdout)
    if shown is PlainFormat.JSON:
        data(json.dumps([_form(*row) for row in rows], indent=2))
    elif rows and width is None:
        data("\n".join("\t".join(printable(column.cell_text(row)) for column in _COLUMNS) for row in rows))
    elif rows and width is not None:
        data("\n".join(table_lines(Table(_COLUMNS, rows, all_in="--format json"), width)))
    statuses = [status for status, _ in rows]
    counts = {status: statuses.count(status) for status in ("covered", "uncovered", "unknown")}
    tally = ", ".join(f"{count} {status}" for status, count in counts.items() if count)
    nothing = "no scenario, series or criterion names a requirement"
    message(f"uictest: {counted(len(rows), 'requirement')}: {tally}" if rows else f"uictest: {nothing}")
    return ExitCode.MISSED if request.fail_uncovered and counts["uncovered"] else ExitCode.MET


def _status(requirement: campaign.CoveredRequirement, listed: frozenset[str] | None) -> Status:
    if listed is not None and requirement.id not in listed:
        return "unknown"
    return "covered" if requirement.covered else "uncovered"


def _verifier_text(verifier: campaign.Verifier) -> str:
    of_profile = f" of {verifier.profile}" if verifier.profile else ""
    counts = counted_in(len(verifier.cases), len(verifier.series))
    return f"{verifier.kind} {verifier.name}{of_profile} ({counts})"


_Row = tuple[Status, "campaign.CoveredRequirement"]
_COLUMNS: Final[tuple[Column[_Row], ...]] = (
    Column(heading="status", text=lambda row: row[0]),
    Column(heading="requirement", text=lambda row: row[1].id, wraps=True),
    Column(
        heading="verified by",
        text=lambda row: "; ".join(map(_verifier_text, row[1].verifiers)),
        rank=1,
        wraps=True,
    ),
)


def _form(status: Status, requirement: campaign.CoveredRequirement) -> dict[str, Any]:
    verifiers = [
        {
            verifier.kind: verifier.name,
            **({"profile": verifier.profile} if verifier.profile else {}),
            "cases": list(verifier.cases),
            "series_ids": list(verifier.series),
        }
        for verifier in requirement.verifiers
    ]
    return {"id": requirement.id, "status": status, "verified_by": verifiers}
