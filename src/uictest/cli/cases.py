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
        found = campaign.selected(among, expression)
    with malformed("-m", tag):
        return campaign.selected(found, tag=tag)


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
    return "\n".join(_described(case) if described else printable(case.id) for case in cases)


def case_table(cases: Sequence[scenario.Case], width: int) -> Iterator[str]:
    """Yield ids, titles and tags as a table in lines of at most so many characters."""
    return table_lines(Table(_CASES, cases, more="--format json has them"), width)


def _described(case: scenario.Case) -> str:
    return "\t".join(printable(text) for text in (case.id, case.scenario.title, " ".join(case.scenario.tags)))


def cases_json(cases: Sequence[scenario.Case]) -> str:
    """Return ids, files, titles, tags, expectations and swept values of cases as a JSON array."""
    return json.dumps([_description(case) for case in cases], indent=2)


def _description(case: scenario.Case) -> dict[str, Any]:
    return {
        "id": case.id,
        "scenario": case.path.as_posix(),
        "title": case.scenario.title,
        "tags": list(case.scenario.tags),
        "expect": case.scenario.expect.form(),
        "parameters": dict(case.parameters),
    }


def series_lines(selected: Sequence[series.Series], *, described: bool = False) -> str:
    """Return the ids, one per line, and below each the ids of its cases; if `described`, with titles."""
    return "\n".join(line for each in selected for line in _lines(each, described=described))


def _lines(each: series.Series, *, described: bool) -> Iterator[str]:
    about = (each.id, each.file.title, " ".join(each.file.tags)) if described else (each.id,)
    yield "\t".join(map(printable, about))
    for stop in each.stops:
        repeat = stop.case.scenario.repeat
        times = f" x {repeat}" if repeat > 1 else ""
        yield f"  {stop.role} {printable(stop.case.id)}{times}"


def series_json(selected: Sequence[series.Series]) -> str:
    """Return ids, files, titles, tags and cases of series as a JSON array."""
    return json.dumps([_description_of_series(each) for each in selected], indent=2)


def joined_json(*arrays: str) -> str:
    """Return JSON arrays as one."""
    return json.dumps([item for array in arrays for item in json.loads(array)], indent=2)


def _description_of_series(each: series.Series) -> dict[str, object]:
    return {
        "id": each.id,
        "series": each.path.as_posix(),
        "title": each.file.title,
        "tags": list(each.file.tags),
        "expect": each.file.expect.form(),
        "parameters": dict(each.parameters),
        "stops": [
            {"role": stop.role, "id": stop.case.id, "repeat": stop.case.scenario.repeat}
            for stop in each.stops
        ],
    }
