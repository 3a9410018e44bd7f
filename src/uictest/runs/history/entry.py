"""What the index of a folder needs of a run, in a file of its own.

The results of a thousand cases take a second to read and check; this takes a millisecond.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Final, Literal

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, NonNegativeInt, ValidationError

from uictest import report
from uictest.core import files
from uictest.runs.history.foreign_files import first_problem

ENTRY: Final = "index-entry.json"
_NAMES_SHOWN: Final = 3
"""Files of scenarios that a subject names; the others are counted."""


class RunEntry(BaseModel):
    """A run as the index shows it, and as its file holds it.

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


def entry_of(content: report.RunContent, results_bytes: int) -> RunEntry:
    """Return the entry of a run."""
    return RunEntry(
        run=encodable(content.name),
        complete=content.complete,
        results_bytes=results_bytes,
        baseline=encodable(content.baseline.folder if content.baseline else ""),
        subject=encodable(_subject(content)),
        controllers=encodable(content.controllers),
        counts=_counts(content.word(result) for result in content.results),
        series=_counts(report.series_word(each) for each in content.series),
        distances=_distances(content),
    )


def write_entry(folder: Path, content: report.RunContent) -> None:
    """Write the entry of a run beside its results.json. Raises OSError."""
    entry = entry_of(content, (folder / report.RESULTS).stat().st_size)
    files.write(folder, ENTRY, entry.model_dump_json(by_alias=True) + "\n")


def read_entry(text: bytes) -> RunEntry:
    """Return the entry in a file. Raises ValueError where it is none."""
    try:
        entry = RunEntry.model_validate_json(text)
    except ValidationError as error:
        raise ValueError(first_problem(error)) from error
    if unknown := {*entry.counts, *entry.series}.difference(report.CASE_WORDS):
        raise ValueError(f"no verdict {min(unknown)!r}")
    return entry


def encodable(text: str) -> str:
    """Return a text that UTF-8 can write: the name of a folder may hold lone surrogates, which it cannot."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def _subject(content: report.RunContent) -> str:
    read = [*(each.file for each in content.series), *(each.scenario for each in content.results)]
    names = list(dict.fromkeys(Path(file).stem.removesuffix(".series") for file in read))
    more = len(names) - _NAMES_SHOWN
    return ", ".join(names[:_NAMES_SHOWN]) + (f" and {more} more" if more > 0 else "")


def _counts(words: Iterable[str]) -> dict[str, int]:
    counted = Counter(words)
    return {word: counted[word] for word in report.CASE_WORDS if word in counted}


def _distances(content: report.RunContent) -> tuple[float, float] | None:
    of_cases = ((each.measures or {}).get("braking_distance_m", math.nan) for each in content.all_results)
    known = [distance for distance in of_cases if math.isfinite(distance)]
    return (min(known), max(known)) if known else None
