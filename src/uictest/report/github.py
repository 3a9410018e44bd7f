"""What GitHub Actions reads: workflow commands for cases, and the summary of a step."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Literal

from uictest.core import files
from uictest.judging import evaluation
from uictest.report.case_words import DIFFERS
from uictest.report.difference import (
    BaselineComparison,
    Difference,
    case_explanation,
    case_word,
    difference_sentences,
)
from uictest.report.escaping import workflow_message, workflow_property
from uictest.report.part_wording import changes_line
from uictest.report.repeat_wording import repeat_sentences, stops_text

LIMIT = 1_000_000
"""Bytes of a summary at most: GitHub refuses a step's summary above 1 MiB."""

_ALWAYS = 2_000  # bytes that a summary may have where others have filled the file


def case_annotations(result: evaluation.CaseResult, differences: Sequence[Difference] = ()) -> Iterator[str]:
    """Yield an `::error` command for a case that misses its expectation or differs from the baseline.

    A case that uses an allowance, or that is as expected while some of its stops are not, has a `::notice`.
    """
    if differences or not result.met:
        title = f"{case_word(result, differences)} {result.id}"
        lines = (*case_explanation(result, differences), *changes_line(result))
        yield annotation(result.scenario, title, "\n".join(lines))
    elif result.allowed:
        title = f"{case_word(result, differences)} {result.id}"
        yield annotation(result.scenario, title, "\n".join(case_explanation(result, ())), level="notice")
    elif result.repeats is not None and result.repeats.turns:
        title = f"{stops_text(result)} {result.id}"
        yield annotation(result.scenario, title, "\n".join(repeat_sentences(result)), level="notice")


def missing_annotations(baseline: BaselineComparison) -> Iterator[str]:
    """Yield an `::error` command for each missing case of the baseline and each series that differs."""
    for own_id, file in baseline.beside_cases.items():
        lines = difference_sentences(baseline.differences[own_id])
        yield annotation(file, f"{DIFFERS} {own_id}", "\n".join(lines))


def annotation(
    file: str,
    title: str,
    message: str,
    line: int | None = None,
    column: int | None = None,
    level: Literal["error", "notice"] = "error",
) -> str:
    """Return one workflow command; `line` and `column` count from 1."""
    properties = {"file": file, "line": line, "col": column, "title": title}
    shown = ",".join(
        f"{name}={workflow_property(str(value))}" for name, value in properties.items() if value is not None
    )
    return f"::{level} {shown}::{workflow_message(message)}"


def append_to_step_summary(summary: Callable[[int], str]) -> None:
    """Append a summary to the file that GitHub Actions names, where it does. Raises OSError.

    Args:
        summary: returns the Markdown in at most so many bytes.

    """
    place = os.environ.get("GITHUB_STEP_SUMMARY")
    if not place:
        return
    path = Path(place)
    written = path.stat().st_size if path.exists() else 0
    files.append(path, summary(max(LIMIT - written, _ALWAYS)))
