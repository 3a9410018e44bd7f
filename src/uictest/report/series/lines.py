"""Series as lines: the word first, then the id; made for grep."""

from __future__ import annotations

from collections.abc import Iterator

from uictest.core.series_measures import SERIES_MEASURES
from uictest.judging.series import SeriesResult
from uictest.report.escaping import printable
from uictest.report.github import annotation
from uictest.report.series.wording import (
    count_sentences,
    not_counted_sentences,
    series_explanation,
    series_verdict_sentence,
    series_word,
    unsettled_of_series,
)
from uictest.report.wording import line_word, number

SHOWN_MEASURES = ("k_wet", "stopping_distance_extension", "passing_share")


def series_line(result: SeriesResult) -> str:
    """Return the line of a series: word, id, outcome, and its measures as `key=value`."""
    words = [line_word(series_word(result)), printable(result.id)]
    words += [f"outcome={result.outcome}", f"expect={result.expect}"]
    for name in SHOWN_MEASURES:
        of_rails = {f"{name}[{each.place.replace(' ', '')}]": each for each in result.speeds if each.rail}
        pooled = SERIES_MEASURES[name].pooled or not of_rails
        for key, measured in ({name: result} if pooled else of_rails).items():
            estimate = measured.measures[name].estimate
            words.append(f"{key}={number(None if estimate is None else estimate.value)}")
    if not result.met:
        reasons = [result.reason] if result.reason else unsettled_of_series(result)
        words.append(f"reason={printable('; '.join(reasons))}")
    return " ".join(words)


def series_lines(result: SeriesResult) -> Iterator[str]:
    """Yield what stands below the line of a series: its criteria, the stops that count and that do not."""
    for each in result.criteria:
        yield f"criterion {printable(result.id)} {series_verdict_sentence(each, result.confidence)}"
    for sentence in (*count_sentences(result), *not_counted_sentences(result)):
        yield f"stops {printable(result.id)} {sentence}"


def series_annotations(result: SeriesResult) -> Iterator[str]:
    """Yield an `::error` command for a series that misses its expectation."""
    if not result.met:
        title = f"{series_word(result)} {result.id}"
        yield annotation(result.file, title, "\n".join(series_explanation(result)))
