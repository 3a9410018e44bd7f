"""The result of a sweep in Markdown, as a job's summary on GitHub shows it."""

from __future__ import annotations

from functools import partial

from uictest.report.github import LIMIT, append_to_step_summary
from uictest.report.sweep.folder import SweepContent, one_file
from uictest.report.sweep.summary_tables import sweep_summary
from uictest.report.text_tables import document_markdown


def sweep_markdown(content: SweepContent, limit: int = LIMIT) -> str:
    """Return the summary: counts, the map of verdicts, the worst cases, and what they depend on.

    What would go beyond `limit` bytes is left out, and lines say how much that is.
    """
    return document_markdown(sweep_summary(content.result), limit, level=2)


def append_sweep_step_summary(content: SweepContent) -> None:
    """Append the summary to the file that GitHub Actions names, where it does. Raises OSError."""
    append_to_step_summary(partial(sweep_markdown, content))


FORMAT = one_file("summary.md", lambda content: sweep_markdown(content).encode())
