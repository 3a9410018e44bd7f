"""Annotations for GitHub Actions: an error for each series that is not as expected."""

from __future__ import annotations

from collections.abc import Iterator

from uictest.judging.series import SeriesResult
from uictest.report.github import annotation
from uictest.report.series.wording import series_explanation, series_word


def series_annotations(result: SeriesResult) -> Iterator[str]:
    """Yield an `::error` command for a series that misses its expectation."""
    if not result.met:
        title = f"{series_word(result)} {result.id}"
        yield annotation(result.file, title, "\n".join(series_explanation(result)))
