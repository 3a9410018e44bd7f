"""One folder among the runs: what it holds, checked as it is read."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final, Literal, NamedTuple

from pydantic import BaseModel, ConfigDict, Field, NonNegativeInt, ValidationError

from uictest import report
from uictest.core import envelope
from uictest.runs.history.entry import ENTRY, RunEntry, read_entry
from uictest.runs.history.foreign_files import (
    UnreadableError,
    bytes_of,
    exists,
    first_problem,
    json_object,
    shown,
)

Kind = Literal["run", "evaluate", "log", "sweep", "fit", "validation", "studies"]
"""What wrote a folder: a command, or a fit, a validation, the studies."""
OF_RECORDINGS: Final[Mapping[str, Kind]] = {"evaluate": "evaluate", "log": "log"}
"""Commands whose runs judge recordings -> the kind of these runs; others simulate."""

MANIFEST: Final = "manifest.json"
_PAGE: Final = "index.html"
_OTHERS: Final[Mapping[str, tuple[Kind, Callable[[Mapping[str, Any]], bool]]]] = {
    "fit.json": ("fit", lambda content: str(content.get("schema")).startswith("uictest/fit/")),
    "validation.json": ("validation", lambda content: envelope.is_of(content, envelope.RESULT, "validation")),
    "studies.json": ("studies", lambda content: str(content.get("schema")).startswith("uictest/studies/")),
}
"""File that names what a folder without manifest holds -> its kind, and whether its content is of that."""
_STARTED: Final = re.compile(r"(?:fit-|validation-)?(\d{8}T\d{6}Z)-[0-9a-f]{8}(?:-\d+)?")


@dataclass(frozen=True, slots=True)
class ListedRun:
    """A folder that uictest wrote.

    Args:
        name: of the folder.
        kind: what wrote it.
        started: when it started; of a sweep and of studies, when the result was written.
        subject: what was run, by name; empty where it is not known.
        controllers: the controllers under test with their versions; empty where none is known.
        inputs: file that was read -> its SHA-256.
        page: its file to open, relative to the folder of all runs; empty where there is none.
        complete: False where selected cases are missing.
        counts: number of cases by word or outcome.
        not_met: number of cases and series that are not as expected.
        series: number of series by word.
        distances: shortest and longest braking distance, m; None where none is known.
        baseline: folder that it was compared with; empty without one.
        note: what readers should know, e.g. why there are no counts.
        order: when the results of a run or a sweep were written, ns; sorts what started in the same second.

    """

    name: str
    kind: Kind
    started: datetime
    subject: str = ""
    controllers: str = ""
    inputs: Mapping[str, str] = field(default_factory=dict)
    page: str = ""
    complete: bool = True
    counts: Mapping[str, int] = field(default_factory=dict)
    not_met: int = 0
    series: Mapping[str, int] = field(default_factory=dict)
    distances: tuple[float, float] | None = None
    baseline: str = ""
    note: str = ""
    order: int = 0


class Unlisted(NamedTuple):
    """A folder that is no finished run, and why."""

    name: str
    reason: str


def read_folder(folder: Path) -> ListedRun | Unlisted:
    """Return what a folder holds, or why it is no run. Raises nothing for what stands in the folder."""
    try:
        if folder.is_symlink():
            return Unlisted(folder.name, f"a link to {folder.readlink()}")
        return _read(folder)
    except UnreadableError as error:
        return Unlisted(folder.name, str(error))
    except OSError as error:
        return Unlisted(folder.name, f"cannot be read: {error.strerror or error}")


def _read(folder: Path) -> ListedRun:
    if not exists(folder / MANIFEST):
        return _other(folder)
    manifest = json_object(folder / MANIFEST)
    if envelope.is_of(manifest, envelope.MANIFEST, "run"):
        return _run(folder, manifest)
    if envelope.is_of(manifest, envelope.MANIFEST, "sweep"):
        return _sweep(folder, manifest)
    raise _other_schema(MANIFEST, manifest)


def _run(folder: Path, content: Mapping[str, Any]) -> ListedRun:
    try:
        manifest = report.read_manifest({"manifest": content})
    except ValueError as error:
        raise UnreadableError(f"{MANIFEST} is damaged: {error}") from error
    if not exists(folder / report.RESULTS):
        raise UnreadableError(f"damaged: there is no {report.RESULTS}")
    kind: Kind = OF_RECORDINGS.get(next(iter(manifest.command[1:2]), ""), "run")
    entry = _entry(folder)
    return ListedRun(
        folder.name,
        kind,
        (started_in(entry.run) if entry else None) or _started(folder, report.RESULTS),
        inputs=manifest.inputs,
        page=_page(folder),
        order=(folder / report.RESULTS).stat().st_mtime_ns,
        **({"note": f"not listed in full: its {ENTRY} is missing"} if entry is None else _of_entry(entry)),
    )


def _of_entry(entry: RunEntry) -> dict[str, Any]:
    not_met = sum(
        count
        for counts in (entry.counts, entry.series)
        for word, count in counts.items()
        if report.tone(word) != "good"
    )
    names = ("complete", "subject", "controllers", "counts", "series", "distances", "baseline")
    return {**{name: getattr(entry, name) for name in names}, "not_met": not_met}


def _entry(folder: Path) -> RunEntry | None:
    """Return the entry of a run; a folder into which only its results were copied has none."""
    if not exists(folder / ENTRY):
        return None
    try:
        entry = read_entry(bytes_of(folder / ENTRY))
    except ValueError as error:
        raise UnreadableError(f"{ENTRY} is damaged: {error}") from error
    size = (folder / report.RESULTS).stat().st_size
    if size != entry.results_bytes:
        raise UnreadableError(
            f"{report.RESULTS} is not what the run wrote: {size} bytes, expected {entry.results_bytes}"
        )
    return entry


def _sweep(folder: Path, manifest: Mapping[str, Any]) -> ListedRun:
    if not exists(folder / report.SWEEP_RESULTS):
        raise UnreadableError("a sweep that is not finished: its command continues it")
    try:
        head = _SweepHead.model_validate_json(bytes_of(folder / report.SWEEP_RESULTS))
    except ValidationError as error:
        raise UnreadableError(f"{report.SWEEP_RESULTS} is damaged: {first_problem(error)}") from error
    if not envelope.is_of({"schema": head.form, "kind": head.kind}, envelope.RESULT, "sweep"):
        raise UnreadableError(f"{report.SWEEP_RESULTS} is damaged: schema {shown(head.form)}")
    if head.name != manifest.get("sweep") or head.cases != manifest.get("cases"):
        raise UnreadableError(
            f"a sweep that is not finished: {report.SWEEP_RESULTS} is of an earlier run of it"
        )
    # Inputs are named relative to the sweep file.
    above = Path(str(manifest.get("file", ""))).parent
    return ListedRun(
        folder.name,
        "sweep",
        _written(folder / report.SWEEP_RESULTS),
        subject=head.name,
        controllers=", ".join(
            report.controller_text(each.name, each.version, built_in=not each.kind)
            for each in head.controllers
        ),
        inputs={str(above / name): digest for name, digest in _texts(manifest.get("inputs")).items()},
        page=_page(folder),
        counts={word: count for word, count in head.outcomes.items() if count},
        not_met=head.cases - head.met,
        order=(folder / report.SWEEP_RESULTS).stat().st_mtime_ns,
    )


class _PartOfResult(BaseModel):
    """Some fields of a document; the others are not read."""

    model_config = ConfigDict(extra="ignore", strict=True)


class _SweptController(_PartOfResult):
    """A controller in the result of a sweep; kind empty if it is built in."""

    name: str
    version: str
    kind: str


class _SweepHead(_PartOfResult):
    """What the index needs of the result of a sweep."""

    form: str = Field(alias="schema")
    kind: str = ""
    name: str
    cases: NonNegativeInt
    met: NonNegativeInt
    outcomes: dict[str, NonNegativeInt]
    controllers: list[_SweptController]


def _other(folder: Path) -> ListedRun:
    for name, (kind, is_own) in _OTHERS.items():
        if not exists(folder / name):
            continue
        content = json_object(folder / name)
        if not is_own(content):
            raise _other_schema(name, content)
        page = _page(folder) or f"{folder.name}/{name}"
        return ListedRun(folder.name, kind, _started(folder, name), page=page)
    raise UnreadableError(f"not of uictest: there is no {MANIFEST}")


def _other_schema(name: str, content: Mapping[str, Any]) -> UnreadableError:
    """Return the reason why a file is not read, by its head."""
    reason = "not read" if envelope.is_old(content) else "not of uictest"
    return UnreadableError(f"{reason}: {name} has {envelope.head_of(content)}")


def _page(folder: Path) -> str:
    return f"{folder.name}/{_PAGE}" if (folder / _PAGE).is_file() else ""


def _started(folder: Path, file: str) -> datetime:
    """Return the start that the name of a folder states, else when the file was written."""
    return started_in(folder.name) or _written(folder / file)


def started_in(name: str) -> datetime | None:
    """Return the start in the name of a run; None where there is none."""
    match = _STARTED.fullmatch(name)
    try:
        return datetime.fromisoformat(match[1]) if match else None
    except ValueError:
        return None


def _written(path: Path) -> datetime:
    return datetime.fromtimestamp(path.stat().st_mtime, UTC)


def _texts(content: object) -> dict[str, str]:
    return {str(key): str(value) for key, value in content.items()} if isinstance(content, Mapping) else {}
