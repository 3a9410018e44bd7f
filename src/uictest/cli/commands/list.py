"""`uictest list`: the ids of cases, or the requirements that they verify."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final, Literal

import typer

from uictest import runs
from uictest.cli import sweep_run
from uictest.cli.cases import (
    case_lines,
    case_table,
    cases_json,
    joined_json,
    select_by_options,
    series_json,
    series_lines,
)
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
        bool,
        option("--requirements", "List requirements and what verifies them instead of cases."),
    ] = False,
    requirement_list: Annotated[
        Path | None,
        option(
            "--requirement-list FILE",
            "All requirements (text, CSV or YAML): with --requirements, shows those not covered, too.",
        ),
    ] = None,
    fail_uncovered: Annotated[
        bool,
        option("--fail-uncovered", "With --requirements: exit with 1 if one is not covered."),
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
    selections = [sweep_run.selected_cases(_plan(path, overrides, trusted), expression) for path in paths]
    for selection in selections:
        if not sweep_run.show_ids(selection):
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
    rows = [(_status(each, listed), each) for each in coverage]
    if shown is PlainFormat.JSON:
        data(json.dumps([_form(status, each) for status, each in rows], indent=2))
    elif rows:
        data("\n".join(_lines(rows, terminal_width(sys.stdout))))
    message(_tally([status for status, _ in rows]))
    uncovered = any(status == "uncovered" for status, _ in rows)
    return ExitCode.MISSED if request.fail_uncovered and uncovered else ExitCode.MET


def _status(requirement: campaign.CoveredRequirement, listed: frozenset[str] | None) -> Status:
    if listed is not None and requirement.id not in listed:
        return "unknown"
    return "covered" if requirement.covered else "uncovered"


def _lines(rows: Sequence[_Row], width: int | None) -> Iterator[str]:
    """Yield a table for a terminal, else a line per requirement with tabs between its texts."""
    if width is None:
        yield from ("\t".join(printable(column.text(row)) for column in _COLUMNS) for row in rows)
    else:
        yield from table_lines(Table(_COLUMNS, rows, more="--format json has them"), width)


def _verifier_text(verifier: campaign.Verifier) -> str:
    of_profile = f" of {verifier.profile}" if verifier.profile else ""
    places = counted_in(len(verifier.cases), len(verifier.series))
    return f"{verifier.kind} {verifier.name}{of_profile} ({places})"


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
    verifiers = [_verifier_form(each) for each in requirement.verifiers]
    return {"id": requirement.id, "status": status, "verified_by": verifiers}


def _verifier_form(verifier: campaign.Verifier) -> dict[str, Any]:
    form: dict[str, Any] = {verifier.kind: verifier.name}
    form |= {"profile": verifier.profile} if verifier.profile else {}
    return form | {"cases": list(verifier.cases), "series_ids": list(verifier.series)}


def _tally(statuses: Sequence[Status]) -> str:
    counts = {status: statuses.count(status) for status in ("covered", "uncovered", "unknown")}
    shown = ", ".join(f"{count} {status}" for status, count in counts.items() if count)
    total = counted(len(statuses), "requirement")
    nothing = "uictest: no scenario, series or criterion names a requirement"
    return f"uictest: {total}: {shown}" if shown else nothing
