"""The runs below a folder, read back within bounds: files may be damaged, endless, or somebody else's."""

from __future__ import annotations

import json
import math
import os
import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final, Literal, NamedTuple

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, NonNegativeInt, ValidationError

from uictest import report
from uictest.core import envelope, files

Kind = Literal["run", "evaluate", "log", "sweep", "fit", "validation", "studies"]
"""What wrote a folder: a command, or a fit, a validation, the studies."""
OF_RECORDINGS: Final[Mapping[str, Kind]] = {"evaluate": "evaluate", "log": "log"}
"""Commands whose runs judge recordings -> the kind of these runs; others simulate."""

MANIFEST: Final = "manifest.json"
ENTRY: Final = "index-entry.json"
_PAGE: Final = "index.html"
_OTHERS: Final[Mapping[str, tuple[Kind, Callable[[Mapping[str, Any]], bool]]]] = {
    "fit.json": ("fit", lambda content: str(content.get("schema")).startswith("uictest/fit/")),
    "validation.json": ("validation", lambda content: envelope.is_of(content, envelope.RESULT, "validation")),
    "studies.json": ("studies", lambda content: str(content.get("schema")).startswith("uictest/studies/")),
}
"""File that names what a folder without manifest holds -> its kind, and whether its content is of that."""
_STARTED: Final = re.compile(r"(?:fit-|validation-)?(\d{8}T\d{6}Z)-[0-9a-f]{8}(?:-\d+)?")
_LARGEST_FILE: Final = 32 << 20
"""Size of the largest file that is read, bytes; chosen."""
FOLDERS_READ: Final = 500
"""Folders that are read, the newest ones by their time of change; chosen."""


@dataclass(frozen=True, slots=True)
class ListedRun:
    """A folder that uictest wrote.

    Args:
        name: name of the folder.
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
    """A folder that is not a finished run, and why."""

    name: str
    reason: str


class Listing(NamedTuple):
    """What stands in a folder of runs.

    Args:
        runs: finished runs, newest first.
        unlisted: the other folders, by name.
        not_read: number of older folders that were not read.
        partial: number of folders that are being filled, or that a killed run left.

    """

    runs: Sequence[ListedRun]
    unlisted: Sequence[Unlisted]
    not_read: int = 0
    partial: int = 0


class UnreadableError(Exception):
    """Why a folder cannot be read as a run."""


def list_runs(parent: Path) -> Listing:
    """Return the listing of a folder of runs. Raises OSError where the folder itself cannot be read."""

    def changed(folder: Path) -> tuple[float, str]:
        try:
            return folder.stat().st_mtime, folder.name
        except OSError:
            return 0.0, folder.name

    folders = [path for path in parent.iterdir() if path.name != files.LATEST and path.is_dir()]
    visible = [folder for folder in folders if not folder.name.startswith(".")]
    newest = sorted(visible, key=changed, reverse=True)[:FOLDERS_READ]
    read = [read_folder(folder) for folder in newest]
    runs = [run for run in read if isinstance(run, ListedRun)]
    return Listing(
        runs=sorted(runs, key=lambda run: (run.started, run.order, run.name), reverse=True),
        unlisted=sorted(other for other in read if isinstance(other, Unlisted)),
        not_read=len(visible) - len(newest),
        partial=sum(folder.name.startswith(".") and folder.name.endswith(".partial") for folder in folders),
    )


def read_folder(folder: Path) -> ListedRun | Unlisted:
    """Return the run in a folder, or why it is not one. Raises nothing for what stands in the folder."""
    try:
        if folder.is_symlink():
            return Unlisted(folder.name, f"a link to {folder.readlink()}")
        if not os.path.lexists(folder / MANIFEST):
            return _listed_other(folder)
        manifest = _json_object(folder / MANIFEST)
        if envelope.is_of(manifest, envelope.MANIFEST, "run"):
            return _listed_run(folder, manifest)
        if envelope.is_of(manifest, envelope.MANIFEST, "sweep"):
            return _listed_sweep(folder, manifest)
        raise _other_schema(MANIFEST, manifest)
    except UnreadableError as error:
        return Unlisted(folder.name, str(error))
    except OSError as error:
        return Unlisted(folder.name, f"cannot be read: {error.strerror or error}")


def started_in(name: str) -> datetime | None:
    """Return the start in the name of a run; None where there is none."""
    match = _STARTED.fullmatch(name)
    try:
        return datetime.fromisoformat(match[1]) if match else None
    except ValueError:
        return None


def _time_written(path: Path) -> datetime:
    return datetime.fromtimestamp(path.stat().st_mtime, UTC)


def _page_path(folder: Path) -> str:
    return f"{folder.name}/{_PAGE}" if (folder / _PAGE).is_file() else ""


def _listed_run(folder: Path, content: Mapping[str, Any]) -> ListedRun:
    try:
        manifest = report.read_manifest({"manifest": content})
    except ValueError as error:
        raise UnreadableError(f"{MANIFEST} is damaged: {error}") from error
    results = folder / report.RESULTS
    if not os.path.lexists(results):
        raise UnreadableError(f"damaged: there is no {report.RESULTS}")
    entry = _checked_entry(folder, results.stat().st_size)
    run = ListedRun(
        folder.name,
        OF_RECORDINGS.get(next(iter(manifest.command[1:2]), ""), "run"),
        (started_in(entry.run) if entry else None) or started_in(folder.name) or _time_written(results),
        inputs=manifest.inputs,
        page=_page_path(folder),
        order=results.stat().st_mtime_ns,
    )
    if entry is None:
        return replace(run, note=f"not listed in full: its {ENTRY} is missing")
    counts = [*entry.counts.items(), *entry.series.items()]
    return replace(
        run,
        subject=entry.subject,
        controllers=entry.controllers,
        complete=entry.complete,
        counts=entry.counts,
        series=entry.series,
        not_met=sum(count for word, count in counts if report.tone(word) != "good"),
        distances=entry.distances,
        baseline=entry.baseline,
    )


def _checked_entry(folder: Path, results_bytes: int) -> RunEntry | None:
    """Return the entry of a run; a folder into which only its results were copied has none."""
    if not os.path.lexists(folder / ENTRY):
        return None
    try:
        entry = read_entry(_bytes_of(folder / ENTRY))
    except ValueError as error:
        raise UnreadableError(f"{ENTRY} is damaged: {error}") from error
    if results_bytes != entry.results_bytes:
        raise UnreadableError(
            f"{report.RESULTS} is not what the run wrote: {results_bytes} bytes,"
            f" expected {entry.results_bytes}"
        )
    return entry


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


def _listed_sweep(folder: Path, manifest: Mapping[str, Any]) -> ListedRun:
    results = folder / report.RESULTS
    if not os.path.lexists(results):
        raise UnreadableError("a sweep that is not finished: its command continues it")
    try:
        head = _SweepHead.model_validate_json(_bytes_of(results))
    except ValidationError as error:
        raise UnreadableError(f"{results.name} is damaged: {_first_problem(error)}") from error
    if not envelope.is_of({"schema": head.form, "kind": head.kind}, envelope.RESULT, "sweep"):
        raise UnreadableError(f"{results.name} is damaged: schema {repr(head.form)[:80]}")
    if head.name != manifest.get("sweep") or head.cases != manifest.get("cases"):
        raise UnreadableError(f"a sweep that is not finished: {results.name} is of an earlier run of it")
    controllers = [
        report.controller_text(controller.name, controller.version, built_in=not controller.kind)
        for controller in head.controllers
    ]
    inputs = manifest.get("inputs")
    # They are named relative to the sweep file.
    above = Path(str(manifest.get("file", ""))).parent
    return ListedRun(
        folder.name,
        "sweep",
        _time_written(results),
        subject=head.name,
        controllers=", ".join(controllers),
        inputs=(
            {str(above / str(name)): str(digest) for name, digest in inputs.items()}
            if isinstance(inputs, Mapping)
            else {}
        ),
        page=_page_path(folder),
        counts={word: count for word, count in head.outcomes.items() if count},
        not_met=head.cases - head.met,
        order=results.stat().st_mtime_ns,
    )


def _listed_other(folder: Path) -> ListedRun:
    for name, (kind, is_own) in _OTHERS.items():
        path = folder / name
        if not os.path.lexists(path):
            continue
        content = _json_object(path)
        if not is_own(content):
            raise _other_schema(name, content)
        started = started_in(folder.name) or _time_written(path)
        return ListedRun(folder.name, kind, started, page=_page_path(folder) or f"{folder.name}/{name}")
    raise UnreadableError(f"not of uictest: there is no {MANIFEST}")


def _other_schema(name: str, content: Mapping[str, Any]) -> UnreadableError:
    reason = "not read" if envelope.is_old(content) else "not of uictest"
    return UnreadableError(f"{reason}: {name} has {envelope.head_of(content)}")


def _json_object(path: Path) -> dict[str, Any]:
    """Return the object in a JSON file. Raises UnreadableError, OSError."""
    try:
        content = json.loads(_bytes_of(path))
    except (ValueError, RecursionError) as error:
        raise UnreadableError(f"{path.name} is damaged: {error}") from error
    if not isinstance(content, dict):
        raise UnreadableError(f"{path.name} is damaged: expected an object")
    return content


def _bytes_of(path: Path) -> bytes:
    """Return the content of a regular file that is not too large. Raises UnreadableError, OSError.

    Anything else could block for ever, or have no end.
    """
    if not path.is_file():
        raise UnreadableError(f"{path.name} is no file")
    if (size := path.stat().st_size) > _LARGEST_FILE:
        raise UnreadableError(f"{path.name} of {size >> 20} MB is not read")
    return path.read_bytes()


def _first_problem(error: ValidationError) -> str:
    """Return the first problem of content that is not what was expected, with its location."""
    problem = error.errors(include_url=False, include_input=False)[0]
    location = ".".join(map(str, problem["loc"]))
    return f"{location}: {problem['msg']}" if location else problem["msg"]


_NAMES_SHOWN: Final = 3
"""Files of scenarios that a subject names; the others are counted."""


class RunEntry(BaseModel):
    """A run as the index shows it, and as a file of its own holds it.

    The results of a thousand cases take a second to read and check; this takes a millisecond.

    Args:
        run: its name, which states its start; its folder may have been renamed.
        complete: False where selected cases are missing.
        results_bytes: size of its results.json, which tells whether that file is still the same.
        baseline: folder that the run was compared with, as given; empty without one.
        subject: the scenarios, series or recordings that were run, by the names of their files.
        controllers: the controllers under test with their versions; empty where none is known.
        counts: number of cases by word.
        series: number of series by word.
        distances: shortest and longest braking distance, m; None without one.

    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    form: Literal["uictest/index/1"] = Field(default="uictest/index/1", alias="schema")
    run: str
    complete: bool
    results_bytes: NonNegativeInt
    baseline: str
    subject: str
    controllers: str
    counts: dict[str, NonNegativeInt]
    series: dict[str, NonNegativeInt]
    distances: tuple[FiniteFloat, FiniteFloat] | None


def write_entry(folder: Path, content: report.RunContent) -> None:
    """Write the entry of a run next to its results.json. Raises OSError."""
    entry = entry_of(content, (folder / report.RESULTS).stat().st_size)
    files.write(folder, ENTRY, entry.model_dump_json(by_alias=True) + "\n")


def entry_of(content: report.RunContent, results_bytes: int) -> RunEntry:
    """Return the entry of a run."""
    read = [*(series.file for series in content.series), *(case.scenario for case in content.results)]
    names = list(dict.fromkeys(Path(file).stem.removesuffix(".series") for file in read))
    more = f" and {len(names) - _NAMES_SHOWN} more" if len(names) > _NAMES_SHOWN else ""
    of_cases = [(case.measures or {}).get("braking_distance_m", math.nan) for case in content.all_results]
    distances = [distance for distance in of_cases if math.isfinite(distance)]
    return RunEntry(
        run=encodable(content.name),
        complete=content.complete,
        results_bytes=results_bytes,
        baseline=encodable(content.baseline.folder if content.baseline else ""),
        subject=encodable(", ".join(names[:_NAMES_SHOWN]) + more),
        controllers=encodable(content.controllers),
        counts=_counts_by_word(content.word(case) for case in content.results),
        series=_counts_by_word(report.result_word(series) for series in content.series),
        distances=(min(distances), max(distances)) if distances else None,
    )


def _counts_by_word(words: Iterable[str]) -> dict[str, int]:
    counted = Counter(words)
    return {word: counted[word] for word in report.CASE_WORDS if word in counted}


def read_entry(text: bytes) -> RunEntry:
    """Return the entry in a file. Raises ValueError where it is none."""
    try:
        entry = RunEntry.model_validate_json(text)
    except ValidationError as error:
        raise ValueError(_first_problem(error)) from error
    if unknown := {*entry.counts, *entry.series}.difference(report.CASE_WORDS):
        raise ValueError(f"no verdict {min(unknown)!r}")
    return entry


def encodable(text: str) -> str:
    """Return a text that UTF-8 can write: the name of a folder may hold lone surrogates, which it cannot."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")
