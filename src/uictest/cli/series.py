"""Find, load and select the series that paths and options name."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path

import typer

from uictest import campaign, scenario, series
from uictest.cli.exit_codes import InvalidInputError
from uictest.report import printable
from uictest.scenario import yaml


def is_series(path: Path) -> bool:
    """Return whether a path names a series file."""
    return path.name.endswith(scenario.SERIES_SUFFIXES)


def series_files(paths: Sequence[Path]) -> Iterator[Path]:
    """Yield the series files among the paths, and those below folders that are not hidden, each once."""
    seen: set[Path] = set()
    for path in paths:
        for file in _below(path) if path.is_dir() else ([path] if is_series(path) else []):
            if file.absolute() not in seen:
                seen.add(file.absolute())
                yield file


def _below(folder: Path) -> list[Path]:
    found = sorted(folder.rglob("*.series.y*ml"), key=Path.as_posix)
    return [each for each in found if is_series(each) and not _hidden(each.relative_to(folder))]


def _hidden(path: Path) -> bool:
    return any(part.startswith(".") for part in path.parts)


def load_series(
    paths: Sequence[Path],
    overrides: Sequence[str] | None,
    seed: int | None,
    trusted: Sequence[Path] | None = None,
) -> list[series.Series]:
    """Return all series of the files. Raises InvalidInputError with every diagnostic of every file."""
    loaded: list[series.Series] = []
    diagnostics: list[yaml.Diagnostic] = []
    for path in paths:
        try:
            loaded += series.load_series(path, tuple(overrides or ()), seed, trusted or ())
        except yaml.ScenarioErrors as errors:
            diagnostics.extend(errors.diagnostics)
    if diagnostics:
        raise InvalidInputError(str(yaml.ScenarioErrors(diagnostics)))
    _require_distinct(loaded)
    return loaded


def _require_distinct(loaded: Sequence[series.Series]) -> None:
    """Raise InvalidInputError where two series have the same id."""
    file_of: dict[str, Path] = {}
    for each in loaded:
        if each.id in file_of:
            where = f"{each.path} and {file_of[each.id]}"
            raise InvalidInputError(
                f"uictest: a second series {each.id!r} in {where}: give every series a name of its own"
            )
        file_of[each.id] = each.path


def select_series(
    loaded: Sequence[series.Series], expression: str | None, tag: str | None
) -> list[series.Series]:
    """Return the series that `-k` and `-m` select. Raises typer.BadParameter for a malformed expression."""
    selected = list(loaded)
    for option, text in (("-k", expression), ("-m", tag)):
        if text is None:
            continue
        try:
            holds = campaign.parse(text)
        except campaign.ExpressionError as error:
            raise typer.BadParameter(f"{error} in {text!r}", param_hint=option) from error
        selected = [each for each in selected if holds(_matcher(each, whole=option == "-m"))]
    return selected


def _matcher(each: series.Series, *, whole: bool) -> campaign.Matches:
    if whole:
        return frozenset(each.file.tags).__contains__
    names = [name.casefold() for name in (each.id, each.path.stem, *each.file.tags)]
    return lambda word: any(word.casefold() in name for name in names)


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
