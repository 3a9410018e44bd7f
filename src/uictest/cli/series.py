"""Select the series that options name, and list them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence

from uictest import runs
from uictest.cli.cases import malformed
from uictest.plans import series
from uictest.report import printable


def select_series_by_options(
    loaded: Sequence[series.Series], expression: str | None, tag: str | None
) -> list[series.Series]:
    """Return the series that `-k` and `-m` select. Raises typer.BadParameter for a malformed expression."""
    with malformed("-k", expression):
        loaded = runs.select_series(loaded, expression)
    with malformed("-m", tag):
        return runs.select_series(loaded, tag=tag)


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
    return json.dumps([_description(each) for each in selected], indent=2)


def joined_json(*arrays: str) -> str:
    """Return JSON arrays as one."""
    return json.dumps([item for array in arrays for item in json.loads(array)], indent=2)


def _description(each: series.Series) -> dict[str, object]:
    return {
        "id": each.id,
        "series": each.path.as_posix(),
        "title": each.file.title,
        "tags": list(each.file.tags),
        "expect": each.file.expect,
        "parameters": dict(each.parameters),
        "stops": [
            {"role": stop.role, "id": stop.case.id, "repeat": stop.case.scenario.repeat}
            for stop in each.stops
        ],
    }
