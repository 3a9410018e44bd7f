"""Annotations for GitHub Actions: the worst missed cases of a sweep, and its counts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from uictest.report.github import annotation
from uictest.report.sweep.folder import SweepContent
from uictest.report.sweep.wording import notable_cases, sweep_tally

MOST_ANNOTATED: Final = 10
"""GitHub shows ten annotations of one kind per step."""


def sweep_annotations(content: SweepContent) -> Iterator[str]:
    """Yield an `::error` for each of the worst cases that are not met, and a `::notice` with the counts."""
    file = str(content.manifest.get("file", ""))
    missed = [case for case in notable_cases(content.result) if not case.met]
    for case in missed[:MOST_ANNOTATED]:
        yield annotation(file, f"{case.word} {case.id}", case.why)
    title = f"uictest sweep {content.result.name}"
    yield annotation(file, title, sweep_tally(content.result), level="notice")
