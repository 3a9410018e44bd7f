"""`uictest list --requirements`: which requirement is verified by which scenarios, series and criteria."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Literal

from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import PlainFormat
from uictest.cli.output import data, message, terminal_width
from uictest.core.document import Column, Table
from uictest.plans import scenario, series
from uictest.report import counted, counted_in, printable, table_lines
from uictest.running import campaign

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
    listed = _listed(request.file)
    coverage = campaign.requirement_coverage(cases, tuple(listed or ()), of_series)
    rows = [(_status(each, listed), each) for each in coverage]
    if shown is PlainFormat.JSON:
        data(json.dumps([_form(status, each) for status, each in rows], indent=2))
    elif rows:
        data("\n".join(_lines(rows, terminal_width(sys.stdout))))
    message(_tally([status for status, _ in rows]))
    uncovered = any(status == "uncovered" for status, _ in rows)
    return ExitCode.MISSED if request.fail_uncovered and uncovered else ExitCode.MET


def _listed(file: Path | None) -> frozenset[str] | None:
    return None if file is None else frozenset(scenario.read_requirement_list(file))


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
