"""A run as text, for a terminal and the log of a CI job: the table of its cases, at the end what failed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from uictest.core.document import Blocks, Lines, Tone
from uictest.judging import evaluation
from uictest.report.case_conditions import domain_sentences
from uictest.report.case_lines import definition_lines, explanation_lines, part_lines
from uictest.report.content import RunContent
from uictest.report.formats.text import (
    coloured_text,
    section_lines,
    table_lines,
    titled_lines,
    wrapped_sentence,
)
from uictest.report.robustness import firmness_sentences
from uictest.report.run_publication import cases_table
from uictest.report.series_report import series_lines_of_terminal
from uictest.report.summary import RunSummary, close_lines, run_summary
from uictest.report.words import counted, printable

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult


def run_lines(
    content: RunContent,
    width: int,
    *,
    coloured: bool = False,
    quiet: bool = False,
    verbose: bool = False,
    most: int | None = None,
) -> Iterator[str]:
    """Yield the lines of a run in so many characters; only names and commands may be longer.

    If `quiet`, only cases that are not as expected, or miss what is allowed. With `verbose`, every criterion
    of every case, the definitions of criteria, and parts. Of the table of cases `most` rows, with a line that
    counts the others.
    """
    summary = run_summary(content)
    results = [
        result for result in content.results if not quiet or result.allowed or not content.passes(result)
    ]
    if summary.subject and not quiet:
        yield from wrapped_sentence(summary.subject, width)
    if content.campaign is not None and content.campaign.tables and (not quiet or content.campaign.failed):
        yield from titled_lines(content.campaign.at_the_top, width)
    elif results:
        yield from table_lines(replace(cases_table(content), rows=results[:most]), width, coloured=coloured)
        if most is not None and len(results) > most:
            yield f"and {counted(len(results) - most, 'more case')}"
    if verbose:
        yield from _details(content, results, width, coloured=coloured)
    series = [result for result in content.series if not (quiet and result.met)]
    if series:
        yield from series_lines_of_terminal(series, width)
    close = close_lines(replace(summary, close=()) if quiet else summary)
    for line in _remarks(summary, [*results, *series], close):
        yield from wrapped_sentence(line, width)
    if close.sentences:
        yield ""
        yield f"{close.title}:"
        for sentence in close.sentences:
            yield from wrapped_sentence(sentence, width, indent="  ")
    for block in summary.blocks:
        yield ""
        yield from section_lines(Blocks([block]), width, coloured=coloured)


def _details(
    content: RunContent, results: Sequence[evaluation.CaseResult], width: int, *, coloured: bool
) -> Iterator[str]:
    """Yield every criterion of every case, then what criteria and parts are, once for all cases."""
    for result in results:
        heading, *lines = explanation_lines(content, result, coloured=coloured)
        yield heading
        for line in lines:
            yield from wrapped_sentence(line, width, indent="  ")
    for line in (*definition_lines(results), *part_lines(results)):
        yield from wrapped_sentence(line, width)


def _remarks(
    summary: RunSummary, judged: Iterable[evaluation.CaseResult | SeriesResult], close: Lines
) -> Iterator[str]:
    """Yield what lies outside of what was validated, and how firm results are, unless `close` says so."""
    unsettled = {group.worst for group in summary.groups if group.kind == "unsettled"}
    for result in judged:
        if isinstance(result, evaluation.CaseResult):
            yield from (f"{result.id}: {sentence}" for sentence in domain_sentences(result))
        if result.id not in unsettled:  # else its group says it
            for line in (f"{result.id}: {sentence}" for sentence in firmness_sentences(result)):
                if not any(close_line.startswith(printable(line)) for close_line in close.sentences):
                    yield line


def last_lines(content: RunContent, ending: str, width: int, *, coloured: bool = False) -> list[str]:
    """Return the last sentence of a run: whether it passed, what failed, and how it ended."""
    summary = run_summary(content)
    word = "PASSED" if summary.answer == "allowed" else summary.answer.upper()
    tone: Tone = "bad" if word == "FAILED" else "good" if word == "PASSED" else "odd"
    first, *further = wrapped_sentence(f"{word}: {summary.headline}{ending}", width)
    return [f"{coloured_text(word, tone if coloured else None)}{first.removeprefix(word)}", *further]
