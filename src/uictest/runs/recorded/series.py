"""Series of recorded stops: a slide-test campaign of a real train, read by one file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from uictest.plans import series
from uictest.runs.recorded.files import RecordedFile, named_map, read_files
from uictest.runs.scenario_files import InvalidInputError, load_series


def read_recorded_series(
    paths: Sequence[Path], overrides: Sequence[str] | None, trusted: Sequence[Path] | None
) -> tuple[list[series.Series], list[RecordedFile]]:
    """Return series with one stop for each recording, and the recordings in the order of the stops.

    Raises InvalidInputError where a recording cannot be read, or a stop names none, and ScenarioErrors.
    """
    read = [_recorded(each, trusted) for each in load_series(paths, overrides, None, trusted)]
    return [planned for planned, _ in read], [file for _, files in read for file in files]


def _recorded(
    planned: series.Series, trusted: Sequence[Path] | None
) -> tuple[series.Series, list[RecordedFile]]:
    """Return a series whose stops are the recordings that its file names, and these."""
    stops: list[series.PlannedStop] = []
    files: list[RecordedFile] = []
    for stop in planned.stops:
        if stop.role == "bypassed":
            continue  # simulated beside simulated stops only
        own, inputs = _files_of(stop, trusted)
        names = [f"{stop.case.id}.{file.name}" for file in own]
        named = [replace(file, name=name) for file, name in zip(own, names, strict=True)]
        stops += [_as_recorded(stop, file, inputs) for file in named]
        files += named
    _require_distinct(planned, stops)
    return replace(planned, stops=tuple(stops)), files


def _as_recorded(stop: series.PlannedStop, file: RecordedFile, inputs: dict[str, str]) -> series.PlannedStop:
    """Return a stop as the one in a recording."""
    return replace(stop, rail="", case=file.case(lambda name, speed: stop.case, inputs))


def _files_of(
    stop: series.PlannedStop, trusted: Sequence[Path] | None
) -> tuple[list[RecordedFile], dict[str, str]]:
    """Return the recordings of a stop, and the files read besides them."""
    if stop.recorded is None:
        raise InvalidInputError(
            f"{stop.case.id} names no recording: list them under `recordings` of its stops, or"
            " simulate the series with 'uictest run'"
        )
    mapped, inputs = named_map(stop.recorded.channel_map, trusted)
    return read_files(stop.recorded.files, mapped), inputs


def _require_distinct(planned: series.Series, stops: Sequence[series.PlannedStop]) -> None:
    seen: set[str] = set()
    for stop in stops:
        if stop.case.id in seen:
            raise InvalidInputError(f"{planned.path}: a second recorded stop {stop.case.id!r}")
        seen.add(stop.case.id)
