"""What the index of a folder needs of a run, in a file of its own.

The results of a thousand cases take a second to read and check; this takes a millisecond.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    FiniteFloat,
    NonNegativeInt,
    ValidationError,
)

from uictest import report
from uictest.core import files
from uictest.judging import evaluation
from uictest.runs.history.foreign_files import first_problem

ENTRY: Final = "index-entry.json"
_SCHEMA: Final = "uictest/index/1"


@dataclass(frozen=True, slots=True)
class CaseEntry:
    """The verdict of a case or of a series, one of `report.CASE_WORDS`, and what it was run with.

    Args:
        id: of the case or the series.
        word: its verdict.
        distance: braking distance, m; None without one.
        parts: ids of the parts that the case was run with, and in the same form the outcome that is expected,
            the recording, and how often and by which rule it repeats its stop; empty for a series.
        is_series: whether it is a series; a case may have the same id.

    """

    id: str
    word: str
    distance: float | None = None
    parts: tuple[str, ...] = ()
    is_series: bool = False

    @property
    def parts_by_kind(self) -> dict[str, list[str]]:
        """The ids of the parts by their kinds."""
        kinds: dict[str, list[str]] = {}
        for part in self.parts:
            kinds.setdefault(part.partition("/")[0], []).append(part)
        return kinds


@dataclass(frozen=True, slots=True)
class RunEntry:
    """A run as the index shows it.

    Args:
        name: of the run, which states its start; its folder may have been renamed.
        complete: False where selected cases are missing.
        results_bytes: size of its results.json, which tells whether that file is still the same.
        baseline: folder that the run was compared with, as given; empty without one.
        counts: number of cases by word.
        series: number of series by word.
        cases: every case, those of series too, then every series.

    """

    name: str
    complete: bool
    results_bytes: int
    baseline: str
    counts: Mapping[str, int]
    series: Mapping[str, int]
    cases: Sequence[CaseEntry]


def entry_of(content: report.RunContent, results_bytes: int) -> RunEntry:
    """Return the entry of a run."""
    series = [CaseEntry(each.id, report.series_word(each), is_series=True) for each in content.series]
    return RunEntry(
        name=content.name,
        complete=content.complete,
        results_bytes=results_bytes,
        baseline=content.baseline.folder if content.baseline else "",
        counts=_counts(content.word(result) for result in content.results),
        series=_counts(each.word for each in series),
        cases=[
            *(_case(result, content.word(result), content.manifest.inputs) for result in content.all_results),
            *series,
        ],
    )


def write_entry(folder: Path, content: report.RunContent) -> None:
    """Write the entry of a run beside its results.json. Raises OSError."""
    entry = entry_of(content, (folder / report.RESULTS).stat().st_size)
    files.write(folder, ENTRY, _written(entry).model_dump_json(by_alias=True) + "\n")


def read_entry(text: bytes, *, with_cases: bool = True) -> RunEntry:
    """Return the entry in a file; `with_cases=False` leaves its cases out, unread.

    Raises ValueError where it is none.
    """
    try:
        form = _Form.model_validate_json(text) if with_cases else _Head.model_validate_json(text)
    except ValidationError as error:
        raise ValueError(first_problem(error)) from error
    _require_words((*form.counts, *form.series))
    return RunEntry(
        name=form.run,
        complete=form.complete,
        results_bytes=form.results_bytes,
        baseline=form.baseline,
        counts=form.counts,
        series=form.series,
        cases=_read_cases(form) if isinstance(form, _Form) else (),
    )


class _Head(BaseModel):
    """The entry in JSON without its cases."""

    model_config = ConfigDict(extra="ignore", strict=True)

    form: Literal["uictest/index/1", "uictest/index-entry/1"] = Field(alias="schema")
    run: str
    complete: bool
    results_bytes: NonNegativeInt
    baseline: str
    counts: dict[str, NonNegativeInt]
    series: dict[str, NonNegativeInt]


class _Form(_Head):
    """The whole entry in JSON: a part is there once, and cases name it by its place."""

    model_config = ConfigDict(extra="forbid", strict=True)

    parts: list[str]
    cases: list[tuple[str, str, FiniteFloat | None, tuple[NonNegativeInt, ...]]]
    series_verdicts: list[tuple[str, str]]


def _written(entry: RunEntry) -> _Form:
    places = {part: n for n, part in enumerate(dict.fromkeys(p for case in entry.cases for p in case.parts))}
    return _Form(
        schema=_SCHEMA,
        run=encodable(entry.name),
        complete=entry.complete,
        results_bytes=entry.results_bytes,
        baseline=encodable(entry.baseline),
        counts=dict(entry.counts),
        series=dict(entry.series),
        parts=list(places),
        cases=[
            (case.id, case.word, case.distance, tuple(places[part] for part in case.parts))
            for case in entry.cases
            if not case.is_series
        ],
        series_verdicts=[(each.id, each.word) for each in entry.cases if each.is_series],
    )


def encodable(text: str) -> str:
    """Return a text that UTF-8 can write: the name of a folder may hold lone surrogates, which it cannot."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def _read_cases(form: _Form) -> list[CaseEntry]:
    _require_words([word for _, word, _, _ in form.cases] + [word for _, word in form.series_verdicts])
    # Cases that were run with the same parts share one tuple of them, which makes them fast to compare.
    shared = {places: _parts_at(places, form.parts) for places in {row[3] for row in form.cases}}
    cases = [CaseEntry(name, word, distance, shared[places]) for name, word, distance, places in form.cases]
    return [*cases, *(CaseEntry(name, word, is_series=True) for name, word in form.series_verdicts)]


def _parts_at(places: tuple[int, ...], parts: Sequence[str]) -> tuple[str, ...]:
    if places and max(places) >= len(parts):
        raise ValueError(f"cases: there are {len(parts)} parts, found number {max(places)}")
    return tuple(parts[place] for place in places)


def _require_words(words: Iterable[str]) -> None:
    if unknown := set(words).difference(report.CASE_WORDS):
        raise ValueError(f"no verdict {min(unknown)!r}")


def _case(result: evaluation.CaseResult, word: str, files: Mapping[str, str]) -> CaseEntry:
    distance = (result.measures or {}).get("braking_distance_m", math.nan)
    return CaseEntry(
        result.id, word, distance if math.isfinite(distance) else None, tuple(_inputs(result, files))
    )


def _inputs(result: evaluation.CaseResult, files: Mapping[str, str]) -> Iterator[str]:
    """Yield what the result follows from; nothing where an earlier version wrote it without its parts.

    `files` are the SHA-256 of what the run read: of a recorded stop, its recording is among them.
    """
    if not result.parts:
        return
    yield from (part.id for part in result.parts.values())
    yield f"expect/{result.expect}"
    if "conditions" in result.parts:
        yield f"recording/{files.get(report.without_machine(result.scenario), '')}"
    if (repeats := result.repeats) is not None:
        share = "" if repeats.required_share is None else f"-{repeats.required_share}"
        yield f"repeat/{len(repeats.stops)}-{repeats.rule}{share}"


def _counts(words: Iterable[str]) -> dict[str, int]:
    counted = Counter(words)
    return {word: counted[word] for word in report.CASE_WORDS if word in counted}
