"""The summary in Markdown, as a job's summary on GitHub shows it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final, NamedTuple

from uictest.core.document import Column, Document, Lines, Table
from uictest.judging import evaluation
from uictest.report import series as series_views
from uictest.report.case_table import cases_table
from uictest.report.close_calls import close_lines
from uictest.report.content import RunContent
from uictest.report.difference import (
    baseline_summary,
    differences_table,
    not_compared_sentences,
    worst_of_wheelsets,
)
from uictest.report.firmness_sentences import firmness_sentences
from uictest.report.formats import ReportFormat
from uictest.report.github import LIMIT, append_to_step_summary
from uictest.report.part_wording import notices
from uictest.report.requirements import REQUIREMENT_TONES, VerifiedRequirement, verified_requirements
from uictest.report.text_tables import document_markdown
from uictest.report.verdict_sentences import listed, reading_sentences

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult

_MOST: Final = 100
"""Requirements, readings and quantities out of tolerance that a reader is shown here."""


def run_summary(content: RunContent) -> Document:
    """Return the whole result of a run: the tally, then one row per case, those not met first."""
    sections = [
        close_lines(content.results, content.series),
        *(content.campaign.sections if content.campaign else ()),
        *series_views.series_sections(content.series),
        *_baseline(content),
        _firmness(content),
        _requirements(content),
        cases_table(content),
        Lines(list(content.passed_over), "Passed over"),
        Table(_READINGS, list(_readings(content.results)), more="more are in `criteria.csv`.", most=_MOST),
    ]
    more = "more tables are in `results.json`."
    return Document(f"uictest: {content.tally}", sections, list(_about(content)), more)


def markdown_summary(content: RunContent, limit: int = LIMIT) -> str:
    """Return the summary in at most so many bytes; what would go beyond is left out, and lines say so."""
    return document_markdown(run_summary(content), limit, level=2)


def append_step_summary(content: RunContent) -> None:
    """Append the summary to the file that GitHub Actions names, where it does. Raises OSError."""
    append_to_step_summary(partial(markdown_summary, content))


def _about(content: RunContent) -> Iterator[str]:
    if not content.complete:
        yield "Incomplete: not all that was selected was run."
    if content.controllers:
        yield f"WSP controller: {content.controllers}."
    yield from (f"{line}." for line in notices(content.all_results))


def _baseline(content: RunContent) -> list[Table | Lines]:
    """Return how the run compares with its baseline, with a table of the quantities out of tolerance."""
    if content.baseline is None:
        return []
    lines = [baseline_summary(content.baseline), *not_compared_sentences(content.baseline)]
    worst = worst_of_wheelsets(content.baseline.all_differences)
    return [Lines(lines), differences_table(worst, most=_MOST)]


def _firmness(content: RunContent) -> Lines:
    """Return how firm the cases and series are of which it was asked."""
    judged: list[evaluation.CaseResult | SeriesResult] = [*content.results, *content.series]
    lines = [f"{each.id}: {line}" for each in judged for line in firmness_sentences(each)]
    return Lines(lines, "Firm or not firm" if lines else "")


_REQUIREMENTS: Final[tuple[Column[VerifiedRequirement], ...]] = (
    Column(heading="requirement", text=lambda each: each.id, literal=True),
    Column(heading="status", text=lambda each: each.status, tone=lambda each: REQUIREMENT_TONES[each.status]),
    Column(heading="tested in", text=lambda each: str(len(each.tested)), right=True),
    Column(
        heading="not met in",
        text=lambda each: listed([f"{evidence.name} ({evidence.word})" for evidence in each.not_met]),
    ),
)


def _requirements(content: RunContent) -> Table:
    """Return the requirements that cases, series or their criteria name, those not met first."""
    verified = verified_requirements(content.results, content.series)
    rows = sorted(verified, key=lambda each: each.status == "met")
    return Table(_REQUIREMENTS, rows, more="more requirements are in `requirements.csv`.", most=_MOST)


class _Reading(NamedTuple):
    case: str
    criterion: str
    sentence: str


_READINGS: Final[tuple[Column[_Reading], ...]] = (
    Column(heading="case", text=lambda each: each.case, literal=True),
    Column(heading="criterion", text=lambda each: each.criterion, literal=True),
    Column(heading="reading", text=lambda each: each.sentence),
)


def _readings(results: Sequence[evaluation.CaseResult]) -> Iterator[_Reading]:
    """Yield the readings of criteria that have several."""
    for result in results:
        for verdict in result.criteria:
            yield from (_Reading(result.id, verdict.id, each) for each in reading_sentences(verdict))


FORMAT = ReportFormat(lambda content: {"summary.md": markdown_summary(content).encode()})
