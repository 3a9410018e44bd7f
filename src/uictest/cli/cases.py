"""Select the cases and series that options name, and list them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Final

import typer

from uictest import runs
from uictest.core.document import Column, Table
from uictest.plans import scenario, series
from uictest.report import printable, table_lines
from uictest.running import campaign

_CASES: Final[tuple[Column[scenario.Case], ...]] = (
    Column(heading="case", text=lambda case: case.id, wraps=True),
    Column(heading="title", text=lambda case: case.scenario.title, rank=1, wraps=True),
    Column(heading="tags", text=lambda case: " ".join(case.scenario.tags), rank=2, wraps=True),
)


def select_by_options(
    among: Sequence[campaign.Selectable], expression: str | None, tag: str | None
) -> list[campaign.Selectable]:
    """Return the cases or series that `-k` and `-m` select.

    Raises typer.BadParameter for a malformed expression.
    """
    with malformed("-k", expression):
        chosen = campaign.selected(among, expression)
    with malformed("-m", tag):
        return campaign.selected(chosen, tag=tag)


def drawn_first(
    cases: Sequence[scenario.Case], planned: Sequence[series.Series], expression: str | None
) -> frozenset[str]:
    """Return the ids of the cases that `--draw` chooses, of series too.

    Raises typer.BadParameter if it chooses none.
    """
    if expression is None:
        return frozenset()
    with malformed("--draw", expression):
        chosen = frozenset(case.id for case in campaign.selected(runs.all_cases(cases, planned), expression))
    if not chosen:
        raise typer.BadParameter(f"no selected case matches {expression!r}", param_hint="--draw")
    return chosen


@contextmanager
def malformed(option: str, text: str | None) -> Iterator[None]:
    """Let a malformed expression be a typer.BadParameter of its option."""
    try:
        yield
    except campaign.ExpressionError as error:
        raise typer.BadParameter(f"{error} in {text!r}", param_hint=option) from error


def case_lines(cases: Sequence[scenario.Case], *, described: bool = False) -> str:
    """Return the ids, one per line; if `described`, each with title and tags, separated by tabs."""
    return "\n".join(
        _listed_line(case.id, case.scenario.title, case.scenario.tags, described=described) for case in cases
    )


def series_lines(selected: Sequence[series.Series], *, described: bool = False) -> str:
    """Return the ids, one per line, and below each the ids of its cases; if `described`, with titles."""
    lines = []
    for planned in selected:
        lines.append(_listed_line(planned.id, planned.file.title, planned.file.tags, described=described))
        for stop in planned.stops:
            repeat = stop.case.scenario.repeat
            times = f" x {repeat}" if repeat > 1 else ""
            lines.append(f"  {stop.role} {printable(stop.case.id)}{times}")
    return "\n".join(lines)


def _listed_line(name: str, title: str, tags: Sequence[str], *, described: bool) -> str:
    texts = (name, title, " ".join(tags)) if described else (name,)
    return "\t".join(map(printable, texts))


def case_table(cases: Sequence[scenario.Case], width: int) -> Iterator[str]:
    """Yield ids, titles and tags as a table in lines of at most so many characters."""
    return table_lines(Table(_CASES, cases, all_in="--format json"), width)


def selection_json(cases: Sequence[scenario.Case], selected: Sequence[series.Series]) -> str:
    """Return ids, files, titles, tags, expectations and values of cases, then of series, as a JSON array."""
    described: list[dict[str, Any]] = [
        {
            "id": case.id,
            "scenario": case.path.as_posix(),
            "title": case.scenario.title,
            "tags": list(case.scenario.tags),
            "expect": case.scenario.expect.form(),
            "parameters": dict(case.parameters),
        }
        for case in cases
    ]
    described += [
        {
            "id": planned.id,
            "series": planned.path.as_posix(),
            "title": planned.file.title,
            "tags": list(planned.file.tags),
            "expect": planned.file.expect.form(),
            "parameters": dict(planned.parameters),
            "stops": [
                {"role": stop.role, "id": stop.case.id, "repeat": stop.case.scenario.repeat}
                for stop in planned.stops
            ],
        }
        for planned in selected
    ]
    return json.dumps(described, indent=2)
