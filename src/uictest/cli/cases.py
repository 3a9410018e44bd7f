"""Load and select the cases that paths and options name."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import typer

from uictest import campaign, scenario, series
from uictest.cli.exit_codes import InvalidInputError
from uictest.report import TableColumn, aligned, columns_not_shown, counted, fitted, printable
from uictest.scenario import yaml

DEFAULT_FOLDER = Path("scenarios")


def scenario_paths(paths: Sequence[Path] | None) -> list[Path]:
    """Return the given paths, else the default folder. Raises InvalidInputError where that is missing."""
    if paths:
        return list(paths)
    if not DEFAULT_FOLDER.is_dir():
        raise InvalidInputError(
            f"uictest: there is no folder {DEFAULT_FOLDER}/ here: name scenario files or folders, "
            "or make a first scenario with 'uictest init'"
        )
    return [DEFAULT_FOLDER]


def load_cases(
    paths: Sequence[Path] | None,
    overrides: Sequence[str] | None,
    seed: int | None,
    trusted: Sequence[Path] | None = None,
) -> list[scenario.Case]:
    """Return all cases of the scenarios. Raises InvalidInputError with every diagnostic of every file.

    Series among the paths are left to others.
    """
    places = [path for path in scenario_paths(paths) if not path.name.endswith(scenario.SERIES_SUFFIXES)]
    if not places:
        return []
    try:
        return scenario.load(places, tuple(overrides or ()), seed, trusted or ())
    except yaml.ScenarioErrors as errors:
        raise InvalidInputError(str(errors)) from errors


def select_by_options(
    cases: Sequence[scenario.Case], expression: str | None, tag: str | None
) -> list[scenario.Case]:
    """Return the cases that `-k` and `-m` select. Raises typer.BadParameter for a malformed expression."""
    selected = list(cases)
    for option, text, select in (("-k", expression, campaign.by_expression), ("-m", tag, campaign.by_tag)):
        if text is None:
            continue
        try:
            selected = select(selected, text)
        except campaign.ExpressionError as error:
            raise typer.BadParameter(f"{error} in {text!r}", param_hint=option) from error
    return selected


def nothing_selected(cases: Sequence[scenario.Case], planned: Sequence[series.Series] = ()) -> str:
    """Return the message for an empty selection, with the number of cases and series and their tags."""
    of_series = {tag for each in planned for tag in each.file.tags}
    tags = sorted({tag for case in cases for tag in case.scenario.tags} | of_series)
    among = f"{counted(len(cases), 'case')}{f' and {len(planned)} series' if planned else ''}"
    return f"uictest: nothing selected among {among}; their tags: {', '.join(tags) or 'none'}"


def case_lines(cases: Sequence[scenario.Case], *, described: bool = False) -> str:
    """Return the ids, one per line; if `described`, each with title and tags, separated by tabs."""
    return "\n".join(_described(case) if described else printable(case.id) for case in cases)


def case_table(cases: Sequence[scenario.Case], width: int) -> Iterator[str]:
    """Yield ids, titles and tags as a table in lines of at most so many characters."""
    columns = [
        TableColumn("case", [printable(case.id) for case in cases], wraps=True),
        TableColumn("title", [printable(case.scenario.title) for case in cases], rank=1, wraps=True),
        TableColumn("tags", [printable(" ".join(case.scenario.tags)) for case in cases], rank=2, wraps=True),
    ]
    shown, hidden = fitted(columns, width)
    yield from aligned(shown)
    if hidden:
        yield columns_not_shown(hidden, "--format json has them")


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
        "expect": case.scenario.expect,
        "parameters": dict(case.parameters),
    }
